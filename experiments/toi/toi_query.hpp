#pragma once

#include "core/motion.hpp"
#include "core/shape.hpp"
#include "experiments/toi/csv_columns.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// One row of a file of queries: two shapes, how they move, and for how long.
struct ToiQuery {
  std::string_view id;  ///< as written, quotes included: a view of the row
  Shape shape_a, shape_b;
  Motion motion_a, motion_b;
  double duration = 0.0;  ///< s
};

/// Where the columns of a file of queries are, and how its rows are read. Const after
/// construction; shared by threads.
class ToiQueryFormat {
 public:
  /// `header` is line `line` of the file; `file` is for messages. Throws `InputError`.
  ToiQueryFormat(std::string_view header, std::int64_t line, const std::string& file);

  /// Memory that reading a row uses: one per thread. Meshes are read once from their files.
  struct Scratch {
    std::vector<std::string_view> fields;
    std::map<std::string, Shape> meshes;
  };
  /// Reads a row. Throws `BadField`.
  [[nodiscard]] ToiQuery read(std::string_view row, Scratch& scratch) const;
  /// The id of a row that may be bad; empty if it has none.
  [[nodiscard]] std::string_view id(std::string_view row, Scratch& scratch) const;

 private:
  static constexpr std::size_t numbers_per_body = 19;

  /// Columns of one body: its numbers in the order of `number_names`, the optional shape, and what
  /// tells a hull, a mesh and a compound.
  struct BodyColumns {
    std::array<std::size_t, numbers_per_body> number{};
    std::array<std::string, numbers_per_body> name;
    std::size_t shape = CsvColumns::absent;
    std::string shape_name;
    std::size_t points = CsvColumns::absent;
    std::string points_name;
    std::size_t file = CsvColumns::absent;
    std::string file_name;
    std::size_t parts = CsvColumns::absent;
    std::string parts_name;
  };

  class Body;
  [[nodiscard]] BodyColumns body_columns(const std::string& prefix) const;
  [[nodiscard]] std::size_t need(const std::string& name) const;

  CsvColumns columns_;
  BodyColumns a_, b_;
  std::size_t id_ = 0;
  std::size_t duration_ = 0;
};

}  // namespace kairos::experiments
