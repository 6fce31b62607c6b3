#include "experiments/vfee/vfee_query.hpp"

#include "core/error.hpp"
#include "core/reading/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace kairos::experiments {
namespace {

constexpr std::size_t absent = static_cast<std::size_t>(-1);

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
    : file_(file), line_(static_cast<int>(line)) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (header.starts_with(byte_order_mark)) {
    header.remove_prefix(byte_order_mark.size());
  }
  std::vector<std::string_view> fields;
  if (!split_fields(header, fields)) {
    throw InputError(file_, line_, "", "the header has a quote that does not end");
  }
  for (const std::string_view field : fields) {
    columns_.emplace_back(unquoted(field));
  }
  id_ = need("id");
  kind_ = need("kind");
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    numbers_[i] = need(column_name(i));
  }
  separation_ = find("separation");
}

std::size_t VfeeFormat::find(const std::string& name) const {
  const auto first = std::find(columns_.begin(), columns_.end(), name);
  if (first == columns_.end()) {
    return absent;
  }
  if (std::find(first + 1, columns_.end(), name) != columns_.end()) {
    throw InputError(file_, line_, name, "is the name of two columns; allowed: one");
  }
  return static_cast<std::size_t>(first - columns_.begin());
}

std::size_t VfeeFormat::need(const std::string& name) const {
  const std::size_t column = find(name);
  if (column == absent) {
    throw InputError(file_, line_, name,
                     "is missing from the header; needed: id, kind, s0x,s0y,s0z to s3z (points at "
                     "the start) and e0x to e3z (at the end); or rows of seven whole numbers");
  }
  return column;
}

std::string_view VfeeFormat::id(std::string_view row, std::vector<std::string_view>& fields) const {
  const bool whole = split_fields(row, fields);
  return whole && id_ < fields.size() ? fields[id_] : std::string_view();
}

VfeeRow VfeeFormat::read(std::string_view row, std::vector<std::string_view>& fields) const {
  if (!split_fields(row, fields)) {
    throw BadField{"", "has a quote that does not end"};
  }
  if (fields.size() != columns_.size()) {
    throw BadField{"", fmt::format("has {} fields; the header names {} columns", fields.size(),
                                   columns_.size())};
  }
  VfeeRow result;
  result.id = fields[id_];
  const std::string_view kind = unquoted(fields[kind_]);
  if (kind != "vf" && kind != "ee") {
    throw BadField{"kind", fmt::format("'{}' is unknown; allowed: vf, ee", kind)};
  }
  result.query.kind = kind == "vf" ? ccd::LinearKind::vertex_face : ccd::LinearKind::edge_edge;
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    coordinate(result.query, i) = read_number(fields[numbers_[i]], columns_[numbers_[i]]);
  }
  if (separation_ != absent && !unquoted(fields[separation_]).empty()) {
    result.query.separation = read_number(fields[separation_], "separation");
    if (result.query.separation < 0.0) {
      throw BadField{"separation",
                     fmt::format("{} is negative; allowed: numbers >= 0", result.query.separation)};
    }
  }
  return result;
}

}  // namespace kairos::experiments
