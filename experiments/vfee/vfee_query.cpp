#include "experiments/vfee/vfee_query.hpp"

#include "core/reading/csv.hpp"

#include <fmt/format.h>

#include <optional>

namespace kairos::experiments {
namespace {

/// Number i of 24: start or end, point, axis.
std::string column_name(std::size_t i) {
  return fmt::format("{}{}{}", i < 12 ? 's' : 'e', i % 12 / 3, "xyz"[i % 3]);
}
double& coordinate(ccd::LinearQuery& query, std::size_t i) {
  ccd::FourPoints& points = i < 12 ? query.start : query.end;
  return points[i % 12 / 3][static_cast<Eigen::Index>(i % 3)];
}

double read_number(std::string_view field, std::string_view column) {
  const std::optional<double> value = parse_number(unquoted(field));
  if (!value) {
    throw BadField{column,
                   fmt::format("'{}' is not allowed; allowed: finite numbers of a double", field)};
  }
  return *value;
}

}  // namespace

VfeeFormat::VfeeFormat(std::string_view header, std::int64_t line, const std::string& file)
    : columns_(header, line, file) {
  constexpr std::string_view needed =
      "id, kind, s0x,s0y,s0z to s3z (points at the start) and e0x to e3z (at the end); or rows of "
      "seven whole numbers";
  id_ = columns_.need("id", needed);
  kind_ = columns_.need("kind", needed);
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    numbers_[i] = columns_.need(column_name(i), needed);
  }
  separation_ = columns_.find("separation");
}

std::string_view VfeeFormat::id(std::string_view row, std::vector<std::string_view>& fields) const {
  return CsvColumns::field(row, id_, fields);
}

VfeeRow VfeeFormat::read(std::string_view row, std::vector<std::string_view>& fields) const {
  columns_.split(row, fields);
  VfeeRow result;
  result.id = fields[id_];
  const std::string_view kind = unquoted(fields[kind_]);
  if (kind != "vf" && kind != "ee") {
    throw BadField{"kind", fmt::format("'{}' is unknown; allowed: vf, ee", kind)};
  }
  result.query.kind = kind == "vf" ? ccd::LinearKind::vertex_face : ccd::LinearKind::edge_edge;
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    coordinate(result.query, i) = read_number(fields[numbers_[i]], columns_.name(numbers_[i]));
  }
  if (separation_ != CsvColumns::absent && !unquoted(fields[separation_]).empty()) {
    result.query.separation = read_number(fields[separation_], "separation");
    if (result.query.separation < 0.0) {
      throw BadField{"separation",
                     fmt::format("{} is negative; allowed: numbers >= 0", result.query.separation)};
    }
  }
  return result;
}

}  // namespace kairos::experiments
