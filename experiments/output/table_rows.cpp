#include "experiments/output/table_rows.hpp"

#include "core/error.hpp"
#include "core/reading/csv.hpp"

#include <fmt/format.h>

namespace kairos::experiments {

TableRows::TableRows(const std::string& path) : path_(path), table_(read_csv(path)) {
  for (std::size_t c = 0; c < table_.columns.size(); ++c) {
    columns_[table_.columns[c]] = c;
  }
}

std::string TableRows::text(std::size_t row, const std::string& column) const {
  const auto found = columns_.find(column);
  if (found == columns_.end()) {
    throw InputError(path_, 1, column, "column is missing; is this what `kairos run` wrote?");
  }
  if (found->second >= table_.rows[row].size()) {
    fail(row, column, "is missing (is the file truncated?)");
  }
  return to_text(table_.rows[row][found->second]);
}

double TableRows::number(std::size_t row, const std::string& column) const {
  const std::string field = text(row, column);
  const auto x = parse_number(field);
  if (!x) {
    fail(row, column, fmt::format("\"{}\" is no number; allowed: a finite number", field));
  }
  return *x;
}

Vector3 TableRows::vector(std::size_t row, const std::string& x, const std::string& y,
                          const std::string& z) const {
  return {number(row, x), number(row, y), number(row, z)};
}

void TableRows::fail(std::size_t row, const std::string& column, const std::string& reason) const {
  throw InputError(path_, static_cast<int>(row) + 2, column, reason);
}

}  // namespace kairos::experiments
