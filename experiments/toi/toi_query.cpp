#include "experiments/toi/toi_query.hpp"

#include "core/compound_body.hpp"
#include "core/mesh_body.hpp"
#include "core/reading/csv.hpp"
#include "core/reading/mesh_file.hpp"
#include "core/reading/point_list.hpp"
#include "simulation/query_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <exception>
#include <optional>
#include <system_error>
#include <utility>

namespace kairos::experiments {
namespace {

constexpr std::array<std::string_view, 19> number_names{"hx", "hy", "hz", "px", "py", "pz", "qw",
                                                        "qx", "qy", "qz", "vx", "vy", "vz", "ax",
                                                        "ay", "az", "wx", "wy", "wz"};
enum NumberIndex : std::size_t { h = 0, p = 3, q = 6, v = 10, a = 13, w = 16 };

/// Largest coordinate of a part of a compound, m: that of a vertex of a mesh.
constexpr double largest_part_number = 1e12;

void refuse(std::string_view column, std::string reason) {
  if (!reason.empty()) {
    throw BadField{column, std::move(reason)};
  }
}

double read_number(std::string_view field, std::string_view column,
                   double largest = largest_magnitude) {
  std::string_view text = unquoted(field);
  if (text.starts_with('+')) {
    text.remove_prefix(1);
  }
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (text.empty() || rest != end || error == std::errc::invalid_argument) {
    throw BadField{column, fmt::format("'{}' is not a number", field)};
  }
  if (error != std::errc()) {
    throw BadField{column, fmt::format("'{}' is beyond the range of a double", field)};
  }
  if (!(std::abs(value) <= largest)) {
    throw BadField{column, fmt::format("'{}' is not allowed; allowed: finite numbers of magnitude "
                                       "up to {}",
                                       field, largest)};
  }
  return value;
}

}  // namespace

ToiQueryFormat::ToiQueryFormat(std::string_view header, std::int64_t line, const std::string& file)
    : columns_(header, line, file) {
  id_ = need("id");
  a_ = body_columns("a_");
  b_ = body_columns("b_");
  duration_ = need("duration");
}

ToiQueryFormat::BodyColumns ToiQueryFormat::body_columns(const std::string& prefix) const {
  BodyColumns columns;
  columns.shape_name = prefix + "shape";
  columns.shape = columns_.find(columns.shape_name);
  columns.points_name = prefix + "points";
  columns.points = columns_.find(columns.points_name);
  columns.file_name = prefix + "file";
  columns.file = columns_.find(columns.file_name);
  columns.parts_name = prefix + "parts";
  columns.parts = columns_.find(columns.parts_name);
  for (std::size_t i = 0; i < numbers_per_body; ++i) {
    columns.name[i] = prefix + std::string(number_names[i]);
    columns.number[i] = need(columns.name[i]);
  }
  return columns;
}

std::size_t ToiQueryFormat::need(const std::string& name) const {
  return columns_.need(name,
                       "id, then hx hy hz px py pz qw qx qy qz vx vy vz ax ay az wx wy wz with a_ "
                       "and with b_ before each, and duration");
}

/// Reads the columns of one body of one row.
class ToiQueryFormat::Body {
 public:
  Body(const BodyColumns& columns, Scratch& scratch)
      : columns_(columns), fields_(scratch.fields), meshes_(scratch.meshes) {}

  [[nodiscard]] Shape shape() const {
    const std::string_view kind = columns_.shape == CsvColumns::absent
                                      ? std::string_view("box")
                                      : unquoted(fields_[columns_.shape]);
    if (kind == "half-space") {
      return HalfSpace{};
    }
    if (kind == "hull") {
      return hull();
    }
    if (kind == "mesh" || kind == "solid") {
      return mesh(kind == "solid");
    }
    if (kind == "compound") {
      return compound();
    }
    const auto found =
        simple(kind.empty() ? "box" : kind, [this](std::size_t k) { return extent(h + k); });
    if (!found) {
      throw BadField{columns_.shape_name,
                     fmt::format("'{}' is unknown; allowed: box, sphere, half-space, capsule, "
                                 "cylinder, cone, hull, mesh, solid, compound",
                                 kind)};
    }
    return *found;
  }

  [[nodiscard]] Motion motion(double duration) const {
    const Pose pose{vector(p), orientation()};
    const Twist twist{vector(v), vector(w)};
    const Vector3 acceleration = vector(a);
    refuse(columns_.name[v], why_too_far(pose, twist, acceleration, duration));
    return Motion::ballistic(Instant{}, duration, pose, twist, acceleration);
  }

 private:
  [[nodiscard]] double number(std::size_t i) const {
    return read_number(fields_[columns_.number[i]], columns_.name[i]);
  }
  [[nodiscard]] Vector3 vector(std::size_t i) const {
    return {number(i), number(i + 1), number(i + 2)};
  }
  [[nodiscard]] double extent(std::size_t i) const {
    const double value = number(i);
    refuse(columns_.name[i], why_no_extent(value));
    return value;
  }
  [[nodiscard]] Quaternion orientation() const {
    Quaternion q_WB(number(q), number(q + 1), number(q + 2), number(q + 3));
    const double norm = q_WB.norm();
    refuse(columns_.name[q], why_not_unit(norm));
    q_WB.coeffs() /= norm;
    return q_WB;
  }

  /// Of points "x y z; x y z; ...", rounded by hx. The position is that of their hull's centroid.
  [[nodiscard]] Shape hull() const {
    if (columns_.points == CsvColumns::absent) {
      throw BadField{columns_.shape_name,
                     fmt::format("a hull needs the column {}", columns_.points_name)};
    }
    const auto points = read_point_list(unquoted(fields_[columns_.points]), [&](auto word) {
      return read_number(word, columns_.points_name);
    });
    const double rounding = number(h);
    if (!points || !(rounding >= 0.0)) {
      throw BadField{!points ? columns_.points_name : columns_.name[h],
                     !points ? "holds no whole number of points; allowed: three numbers each"
                             : "is below 0; allowed: the rounding of the hull (m)"};
    }
    try {
      ConvexHull found = convex_hull(*points);
      refuse(columns_.points_name, why_no_extent(found.polytope->width));
      return Hull{std::move(found.polytope), rounding};
    } catch (const std::exception& error) {
      throw BadField{columns_.points_name, error.what()};
    }
  }

  /// The shape that three sizes describe; nothing for other kinds.
  template <typename Extent>
  [[nodiscard]] static std::optional<Shape> simple(std::string_view kind, const Extent& size) {
    if (kind == "box") {
      return Box{{size(0), size(1), size(2)}};
    }
    if (kind == "sphere") {
      return Sphere{size(0)};
    }
    if (kind == "capsule") {
      return Capsule{size(0), 2.0 * size(1)};
    }
    if (kind == "cylinder") {
      return Cylinder{size(0), 2.0 * size(1)};
    }
    if (kind == "cone") {
      return Cone{size(0), 2.0 * size(1)};
    }
    return std::nullopt;
  }

  /// The text of a column that a shape needs.
  [[nodiscard]] std::string_view needed(std::size_t column, const std::string& name,
                                        std::string_view shape) const {
    if (column == CsvColumns::absent || unquoted(fields_[column]).empty()) {
      throw BadField{columns_.shape_name, fmt::format("a {} needs the column {}", shape, name)};
    }
    return unquoted(fields_[column]);
  }

  /// Triangles of a file, a unit of which is hx; about the origin of the file.
  [[nodiscard]] Shape mesh(bool solid) const {
    const std::string_view path = needed(columns_.file, columns_.file_name, "mesh");
    const double unit = extent(h);
    Shape& shape = meshes_[fmt::format("{} {} {}", solid, unit, path)];
    if (!std::holds_alternative<Mesh>(shape)) {
      using Kind = CollisionMesh::Kind;
      try {
        shape = Mesh{mesh_in_place(read_mesh(std::string(path), unit).mesh,
                                   solid ? Kind::solid : Kind::surface)};
      } catch (const std::exception& error) {
        throw BadField{columns_.file_name, error.what()};
      }
    }
    return shape;
  }

  /// Of parts "shape hx hy hz px py pz qw qx qy qz; ...", about the origin that they are told
  /// about.
  [[nodiscard]] Shape compound() const {
    std::string_view text = needed(columns_.parts, columns_.parts_name, "compound");
    std::vector<CompoundPart> parts;
    while (!trimmed(text).empty()) {
      const std::size_t end = std::min(text.find(';'), text.size());
      parts.push_back(part(trimmed(text.substr(0, end))));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    return Compound{compound_in_place(std::move(parts))};
  }

  [[nodiscard]] CompoundPart part(std::string_view text) const {
    constexpr std::size_t numbers_of_part = 10;
    const std::string& column = columns_.parts_name;
    const std::string_view kind = text.substr(0, text.find(' '));
    text.remove_prefix(kind.size());
    std::vector<double> number;
    for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
      const std::string_view word = text.substr(0, text.find(' '));
      number.push_back(read_number(word, column, largest_part_number));
      text.remove_prefix(word.size());
    }
    if (number.size() != numbers_of_part) {
      throw BadField{column, fmt::format("has a part of {} numbers; allowed: a shape, then hx hy "
                                         "hz px py pz qw qx qy qz",
                                         number.size())};
    }
    const auto shape = simple(kind, [&](std::size_t k) {
      refuse(column, why_no_extent(number[k]));
      return number[k];
    });
    if (!shape) {
      throw BadField{column,
                     fmt::format("has a part '{}'; allowed: box, sphere, capsule, cylinder, "
                                 "cone",
                                 kind)};
    }
    Quaternion q_BP(number[6], number[7], number[8], number[9]);
    const double norm = q_BP.norm();
    refuse(column, why_not_unit(norm));
    q_BP.coeffs() /= norm;
    return {*shape, {{number[3], number[4], number[5]}, q_BP}};
  }

  const BodyColumns& columns_;
  const std::vector<std::string_view>& fields_;
  std::map<std::string, Shape>& meshes_;
};

std::string_view ToiQueryFormat::id(std::string_view row, Scratch& scratch) const {
  return CsvColumns::field(row, id_, scratch.fields);
}

ToiQuery ToiQueryFormat::read(std::string_view row, Scratch& scratch) const {
  std::vector<std::string_view>& fields = scratch.fields;
  columns_.split(row, fields);
  ToiQuery query;
  query.id = fields[id_];
  query.duration = read_number(fields[duration_], "duration", longest_duration_asked);
  refuse("duration", why_no_window(query.duration));
  const Body body_a(a_, scratch);
  const Body body_b(b_, scratch);
  query.shape_a = body_a.shape();
  query.shape_b = body_b.shape();
  if (std::holds_alternative<HalfSpace>(query.shape_a) &&
      std::holds_alternative<HalfSpace>(query.shape_b)) {
    throw BadField{"b_shape", "two half-spaces have no time of impact; allowed: at most one"};
  }
  query.motion_a = body_a.motion(query.duration);
  query.motion_b = body_b.motion(query.duration);
  return query;
}

}  // namespace kairos::experiments
