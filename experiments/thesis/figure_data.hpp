#pragma once

#include "experiments/output/table.hpp"
#include "experiments/sweeps/sweep_spec.hpp"

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kairos::experiments {

class OutputFolder;

/// A column of a figure's table.
struct FigureColumn {
  std::string name;
  std::string unit;  ///< empty: a count, a ratio, or text
  std::string meaning;
};

/// The data of one figure while it is made: tables, and single numbers that texts and the paper
/// quote. What is drawn and what is written comes from here and from nowhere else.
class FigureData {
 public:
  FigureData(std::string folder, Size size) : folder_(std::move(folder)), size_(size) {}

  [[nodiscard]] Size size() const { return size_; }
  /// Where the figure's files are.
  [[nodiscard]] const std::string& folder() const { return folder_; }

  /// A new table, `NAME.csv`; the reference stays valid.
  Table& table(const std::string& name, const std::vector<FigureColumn>& columns);
  /// A number that texts quote as `{name}`; `digits` significant ones are quoted, all are kept.
  void value(std::string_view name, double x, std::string_view unit, std::string_view meaning,
             int digits = 4);
  void count(std::string_view name, std::int64_t n, std::string_view meaning);
  void text(std::string_view name, std::string_view value, std::string_view meaning);

  /// A value by its name. Throws `std::out_of_range` where there is no such number.
  [[nodiscard]] double number(std::string_view name) const;
  /// `text` with each `{name}` replaced by that value and its unit, as quoted. Throws
  /// `std::out_of_range` where there is no such value.
  [[nodiscard]] std::string filled(std::string_view text) const;
  /// Makes the tables, `values.csv` (what is quoted) and `columns.csv` (what columns mean).
  void write(OutputFolder& out) const;

 private:
  struct Named {
    std::string name;
    Table table;
  };

  [[nodiscard]] const std::vector<Cell>& row(std::string_view name) const;
  void add_value(std::string_view name, Cell value, std::string_view unit, std::string quoted,
                 std::string_view meaning);

  std::string folder_;
  Size size_;
  std::deque<Named> tables_;
  Table columns_{{"sweep", "column", "role", "unit", "label", "scale"}, {}};
  Table values_{{"name", "value", "unit", "quoted", "meaning"}, {}};
};

}  // namespace kairos::experiments
