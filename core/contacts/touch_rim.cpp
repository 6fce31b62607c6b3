#include "core/contacts/touch_rim.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

using Kind = TouchFeature::Kind;
using Side = TouchRim::Side;
using Sides = std::vector<TouchRim::Side>;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Features have the directions and places of the shape's own up to this.
constexpr double same = 1e-6;

Side through(const Vector3& normal, const Vector3& x) { return {normal, normal.dot(x)}; }

// --- Boxes -------------------------------------------------------------------------------------

Sides box_sides(const Vector3& half, const TouchFeature& feature) {
  Sides sides;
  for (int k = 0; k < 3; ++k) {
    const Vector3 axis = Vector3::Unit(k);
    const bool along = std::abs(feature.direction[k]) > 0.5;
    // A line ends at the faces across it, and a face at those beside it.
    if (feature.kind != Kind::ball && along == (feature.kind == Kind::line)) {
      sides.push_back({axis, half[k]});
      sides.push_back({-axis, half[k]});
    } else if (feature.kind != Kind::plane) {
      const double sign = feature.at[k] < 0.0 ? -1.0 : 1.0;
      sides.push_back({-sign * axis, -half[k]});
    }
  }
  return sides;
}

// --- Hulls -------------------------------------------------------------------------------------

std::optional<Sides> face_sides(const Polytope& p, const Vector3& normal) {
  for (std::size_t f = 0; f < p.faces.size(); ++f) {
    if ((p.normals[f] - normal).norm() > same) {
      continue;
    }
    Sides sides;
    const auto corners = p.faces[f];
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vector3& x = p.vertices[corners[k]];
      const Vector3 along = p.vertices[corners[(k + 1) % corners.size()]] - x;
      sides.push_back(through(along.cross(p.normals[f]).normalized(), x));
    }
    return sides;
  }
  return std::nullopt;
}

std::optional<Sides> edge_sides(const Polytope& p, const TouchFeature& line) {
  for (const auto& [i, j] : p.edges) {
    const Vector3& x = p.vertices[i];
    const Vector3 along = (p.vertices[j] - x).normalized();
    const Vector3 from = line.at - x;
    if (along.cross(line.direction).norm() > same || along.cross(from).norm() > same * p.radius) {
      continue;
    }
    Sides sides{through(along, p.vertices[j]), through(-along, x)};
    for (std::size_t f = 0; f < p.faces.size(); ++f) {
      const auto corners = p.faces[f];
      const auto has = [&](std::uint32_t v) {
        return std::find(corners.begin(), corners.end(), v) != corners.end();
      };
      if (has(i) && has(j)) {
        Vector3 into = p.normals[f].cross(along);
        into = into.dot(p.vertices[corners[0]] + p.vertices[corners[1]] + p.vertices[corners[2]] -
                        3.0 * x) < 0.0
                   ? Vector3(-into)
                   : into;
        sides.push_back(through(into.normalized(), x));
      }
    }
    return sides;
  }
  return std::nullopt;
}

std::optional<Sides> corner_sides(const Polytope& p, const Vector3& at) {
  for (std::uint32_t v = 0; v < p.vertices.size(); ++v) {
    if ((p.vertices[v] - at).norm() > same * p.radius) {
      continue;
    }
    Sides sides;
    for (const auto& [i, j] : p.edges) {
      if (i == v || j == v) {
        const Vector3 along = p.vertices[i == v ? j : i] - p.vertices[v];
        sides.push_back(through(along.normalized(), p.vertices[v]));
      }
    }
    return sides;
  }
  return std::nullopt;
}

/// The radius of the flat face of what is round; 0: it is no such face.
double radius_of_disc(const TouchFeature& feature, const Shape& shape) {
  if (feature.kind != Kind::plane) {
    return 0.0;
  }
  const auto* cylinder = std::get_if<Cylinder>(&shape);
  const auto* cone = std::get_if<Cone>(&shape);
  return cylinder != nullptr ? cylinder->radius : cone != nullptr ? cone->radius : 0.0;
}

/// The region of space that is nearest to a feature, as far as `TouchRim` asks.
std::optional<Sides> region(const TouchFeature& feature, const Shape& shape) {
  if (std::holds_alternative<HalfSpace>(shape) || std::holds_alternative<Sphere>(shape)) {
    return Sides{};
  }
  if (feature.kind == Kind::rim) {
    const double side = std::copysign(1.0, feature.at.y());
    return std::holds_alternative<Cylinder>(shape)
               ? Sides{{-side * Vector3::UnitY(), -std::abs(feature.at.y())}}
               : Sides{};
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape);
      cylinder && feature.kind == Kind::line) {
    const double end = 0.5 * cylinder->length;
    return Sides{{Vector3::UnitY(), end}, {-Vector3::UnitY(), end}};
  }
  if (const auto* cone = std::get_if<Cone>(&shape); cone && feature.kind == Kind::cone) {
    return Sides{{Vector3::UnitY(), 0.75 * cone->height}, {-Vector3::UnitY(), 0.25 * cone->height}};
  }
  if (radius_of_disc(feature, shape) > 0.0) {
    return Sides{};
  }
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    const double end = 0.5 * capsule->length;
    switch (feature.kind) {
      case Kind::ball:
        return Sides{through(Vector3::UnitY() * (feature.at.y() < 0.0 ? 1.0 : -1.0), feature.at)};
      case Kind::line:
        return Sides{{Vector3::UnitY(), end}, {-Vector3::UnitY(), end}};
      case Kind::plane:
      case Kind::rim:
      case Kind::cone:
        return std::nullopt;
    }
  }
  if (const auto* box = std::get_if<Box>(&shape)) {
    return box_sides(box->half_extents, feature);
  }
  if (const auto* hull = std::get_if<Hull>(&shape)) {
    const Polytope& p = *hull->core;
    return feature.kind == Kind::plane  ? face_sides(p, feature.direction)
           : feature.kind == Kind::line ? edge_sides(p, feature)
                                        : corner_sides(p, feature.at);
  }
  return std::nullopt;
}

/// Whether a ball feature is a ball or a corner of the shape, and not where two edges cross.
bool is_corner(const TouchFeature& feature, const Shape& shape) {
  const auto corners = extremes_of(shape);
  return corners && std::any_of(corners->begin(), corners->end(),
                                [&](const TouchFeature& c) { return c.at == feature.at; });
}

/// How far x is beyond a disc about the y axis, m.
double beyond_disc(double radius, const Vector3& x) {
  return Vector3(x.x(), 0.0, x.z()).norm() - radius;
}

double beyond_sides(const Sides& sides, const Vector3& x) {
  double most = -infinity;
  for (const Side& side : sides) {
    most = std::max(most, side.normal.dot(x) - side.offset);
  }
  return most;
}

}  // namespace

double TouchRim::beyond(const Touch& touch, const BodyState& a, const BodyState& b) const {
  if (of_normal) {
    const TouchNow now = look_at(touch, a, b);
    const TouchFeature& rim = of_a ? touch.on_a : touch.on_b;
    const Pose& piece = of_a ? touch.piece_a : touch.piece_b;
    const Pose& body = of_a ? a.pose : b.pose;
    const Vector3 out = (of_a ? now.point_a : now.point_b) - body.to_world(piece.to_world(rim.at));
    return (of_a ? -1.0 : 1.0) * now.normal.dot(out);
  }
  const Pose& own = of_a ? a.pose : b.pose;
  const Pose& other = of_a ? touch.piece_b : touch.piece_a;
  Vector3 at = (of_a ? b : a).pose.to_world(other.to_world((of_a ? touch.on_b : touch.on_a).at));
  if (of_lines) {
    const TouchNow now = look_at(touch, a, b);
    at = of_a ? now.point_a : now.point_b;
  }
  const Vector3 x = (of_a ? touch.piece_a : touch.piece_b).to_body(own.to_body(at));
  const double beyond =
      std::max(beyond_sides(sides, x), inner > 0.0 ? -beyond_disc(inner, x) : -infinity);
  return radius > 0.0 ? std::max(beyond, beyond_disc(radius, x)) : beyond;
}

std::optional<std::vector<TouchRim>> rims_of(const Touch& touch, const Shape& a, const Shape& b) {
  std::vector<TouchRim> rims;
  for (const bool of_a : {true, false}) {
    const TouchFeature& feature = of_a ? touch.on_a : touch.on_b;
    const TouchFeature& other = of_a ? touch.on_b : touch.on_a;
    const bool lines = feature.kind == Kind::line && other.crosses();
    if (feature.kind == Kind::rim && other.crosses()) {
      TouchRim around;
      around.of_a = of_a;
      around.of_normal = true;
      rims.push_back(std::move(around));
      continue;
    }
    // A cap ends where its side begins.
    const bool cap = feature.kind == Kind::ball &&
                     (other.kind == Kind::line || other.kind == Kind::cone) &&
                     std::holds_alternative<Capsule>(of_a ? a : b);
    const bool of_lines = lines || cap || feature.kind == Kind::cone || other.kind == Kind::rim;
    if (!of_lines && (other.kind != Kind::ball || !is_corner(other, of_a ? b : a))) {
      continue;
    }
    auto sides = region(feature, of_a ? a : b);
    if (!sides) {
      return std::nullopt;
    }
    const bool rim = feature.kind == Kind::rim;
    if (rim && other.kind == Kind::plane) {
      continue;  // all round it is the lowest
    }
    if (lines) {
      // The faces beside an edge are left out: corners that come down are watched anyway.
      std::erase_if(*sides, [&](const Side& side) {
        return std::abs(side.normal.dot(feature.direction)) < 0.5;
      });
    }
    const double radius = radius_of_disc(feature, of_a ? a : b);
    if (!sides->empty() || radius > 0.0) {
      rims.push_back({std::move(*sides), radius, rim ? feature.radius : 0.0, of_a, of_lines});
    }
  }
  return rims;
}

std::optional<std::vector<TouchRim::Side>> sides_of_face(const Shape& shape,
                                                         const Vector3& outward) {
  const auto* hull = std::get_if<Hull>(&shape);
  if (hull == nullptr && !std::holds_alternative<Box>(shape)) {
    return std::nullopt;
  }
  TouchFeature face;
  face.kind = Kind::plane;
  face.direction = outward;
  return region(face, shape);
}

double beyond_region(const TouchFeature& feature, const Shape& shape, const Vector3& x) {
  const auto sides = region(feature, shape);
  if (feature.kind == Kind::cone) {  // of what is above it
    return beyond_sides(*sides, look_at(feature, x).point_a);
  }
  const double radius = radius_of_disc(feature, shape);
  double beyond = sides ? beyond_sides(*sides, x) : infinity;
  if (feature.kind == Kind::rim) {
    beyond = std::max(beyond, -beyond_disc(feature.radius, x));
  }
  return radius > 0.0 ? std::max(beyond, beyond_disc(radius, x)) : beyond;
}

}  // namespace core
}  // namespace kairos
