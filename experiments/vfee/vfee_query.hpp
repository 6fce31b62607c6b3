#pragma once

#include "ccd/linear/linear_impact.hpp"
#include "experiments/toi/csv_columns.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// One row of a file of queries about vertices, faces and edges.
struct VfeeRow {
  std::string_view id;  ///< as written, quotes included: a view of the row
  ccd::LinearQuery query;
};

/// Where the columns of such a file are: id, kind (vf or ee), then for each point i in 0..3 its
/// coordinates at the start, s0x,s0y,s0z ... s3z, and at the end, e0x ... e3z; `separation` may
/// follow. Const after construction; shared by threads.
class VfeeFormat {
 public:
  /// `header` is line `line` of the file; `file` is for messages. Throws `InputError`.
  VfeeFormat(std::string_view header, std::int64_t line, const std::string& file);

  /// Reads a row into fields of its own, which are used again. Throws `BadField`.
  [[nodiscard]] VfeeRow read(std::string_view row, std::vector<std::string_view>& fields) const;
  /// The id of a row that may be bad; empty if it has none.
  [[nodiscard]] std::string_view id(std::string_view row,
                                    std::vector<std::string_view>& fields) const;

 private:
  CsvColumns columns_;
  std::size_t id_, kind_, separation_;
  std::array<std::size_t, 24> numbers_{};
};

/// A public data set's query [Wang2021]: eight rows x, y, z of points 0 to 3 at the start and at
/// the end, each number as numerator,denominator, and a last field that tells (0 or 1) whether they
/// meet.
struct RationalQuery {
  static constexpr std::size_t rows = 8;

  ccd::LinearQuery query;
  bool meets = false;  ///< as the file says
};

/// Whether a line is a row of such a query: seven whole numbers.
[[nodiscard]] bool is_rational_row(std::string_view line);
/// Reads eight rows. Throws `BadField`, also where a number is no double.
[[nodiscard]] RationalQuery read_rational_query(std::span<const std::string_view> rows,
                                                ccd::LinearKind kind);

}  // namespace kairos::experiments
