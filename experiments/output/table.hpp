#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace kairos::experiments {

/// One cell: empty (unknown, or not a finite number), a number, a count, or text.
using Cell = std::variant<std::monostate, double, std::int64_t, std::string>;

/// A finite number, or an empty cell: NaN and infinity never travel.
[[nodiscard]] Cell number_cell(double x);

/// Rows under named columns: what every experiment writes and every figure reads.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;

  /// Comma-separated, RFC 4180 quoting, numbers in the shortest form that reads back the same.
  [[nodiscard]] std::string csv() const;
  /// Index of a column; throws `std::out_of_range` with the columns that exist.
  [[nodiscard]] std::size_t column(const std::string& name) const;
};

/// As in the CSV, without quotes.
[[nodiscard]] std::string to_text(const Cell& cell);

/// A row as a line of CSV, as in `Table::csv`, with its line break.
[[nodiscard]] std::string csv_line(const std::vector<Cell>& row);

/// Reads what `Table::csv` writes; every cell is text. Throws `InputError` where it is not a table.
[[nodiscard]] Table read_csv(const std::string& path);

}  // namespace kairos::experiments
