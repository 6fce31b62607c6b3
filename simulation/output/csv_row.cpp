#include "simulation/output/csv_row.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace kairos {
inline namespace simulation {

void CsvRow::separate() {
  if (finished_) {
    line_.clear();
    finished_ = false;
  } else {
    line_ += ',';
  }
}

CsvRow& CsvRow::text(std::string_view value) {
  separate();
  if (value.find_first_of(",\"\n\r") == std::string_view::npos) {
    line_ += value;
    return *this;
  }
  line_ += '"';
  for (const char c : value) {
    line_.append(c == '"' ? 2 : 1, c);
  }
  line_ += '"';
  return *this;
}

CsvRow& CsvRow::field(std::string_view value) {
  separate();
  line_ += value;
  return *this;
}

CsvRow& CsvRow::number(double value) {
  separate();
  if (std::isfinite(value)) {
    fmt::format_to(std::back_inserter(line_), FMT_COMPILE("{}"), value);
  }
  return *this;
}

CsvRow& CsvRow::count(std::int64_t value) {
  separate();
  fmt::format_to(std::back_inserter(line_), FMT_COMPILE("{}"), value);
  return *this;
}

CsvRow& CsvRow::vector(const Vector3& value) {
  return number(value.x()).number(value.y()).number(value.z());
}

CsvRow& CsvRow::quaternion(const Quaternion& value) {
  return number(value.w()).number(value.x()).number(value.y()).number(value.z());
}

std::string_view CsvRow::finish() {
  line_ += '\n';
  finished_ = true;
  return line_;
}

}  // namespace simulation
}  // namespace kairos
