#pragma once

#include "core/polytope.hpp"

#include <array>
#include <memory>
#include <string_view>
#include <variant>

namespace kairos {
inline namespace core {

/// Ball around the body's origin.
struct Sphere {
  double radius = 0.0;  ///< m
};
/// Box centred on the body's origin, edges along its axes.
struct Box {
  Vector3 half_extents = Vector3::Zero();  ///< m
};
/// All points x of the body frame with normal_B . x <= 0. The normal is kept as it was given and
/// not as a rotation of +y, which no unit quaternion of doubles does exactly: along an axis it
/// stays so.
struct HalfSpace {
  Vector3 normal_B = Vector3::UnitY();  ///< outward, unit, body frame
};

/// All points within `radius` of a piece of the body's y axis, centred on the origin.
struct Capsule {
  double radius = 0.0;  ///< m
  double length = 0.0;  ///< of the piece: from centre to centre of the two caps, m
};
/// About the body's y axis, centred on the origin.
struct Cylinder {
  double radius = 0.0;  ///< m
  double length = 0.0;  ///< from face to face, m
};
/// About the body's y axis, its apex up; the origin is its centroid, a quarter of the height above
/// the base.
struct Cone {
  double radius = 0.0;  ///< of the base, m
  double height = 0.0;  ///< m
};
/// All points within `rounding` of a convex polytope.
struct Hull {
  std::shared_ptr<const Polytope> core;
  double rounding = 0.0;  ///< m
};

struct MeshBody;
/// Triangles: a surface, or the solid that they enclose (see core/mesh_body.hpp).
struct Mesh {
  std::shared_ptr<const MeshBody> body;
};
struct CompoundBody;
/// Several convex shapes that move as one (see core/compound_body.hpp).
struct Compound {
  std::shared_ptr<const CompoundBody> body;
};

/// What a body collides as: a closed set, visited once per query, outside every loop.
using Shape = std::variant<Sphere, Box, HalfSpace, Capsule, Cylinder, Cone, Hull, Mesh, Compound>;

/// The order in which a pair is asked for: spheres first, half-spaces last.
[[nodiscard]] inline int shape_rank(const Shape& shape) {
  constexpr std::array<int, std::variant_size_v<Shape>> rank{0, 1, 8, 2, 3, 4, 5, 6, 7};
  return rank[shape.index()];
}

/// As scene files say it.
[[nodiscard]] std::string_view shape_name(const Shape& shape);
/// Radius of the smallest ball around the origin that contains the shape, m (infinite: half-space).
[[nodiscard]] double bounding_radius(const Shape& shape);
/// Smallest full extent (a sphere's diameter, a box's thinnest side), m; infinite for a half-space.
[[nodiscard]] double smallest_extent(const Shape& shape);
/// Principal moments of inertia of the homogeneous solid about its origin, kg m^2; of a
/// hull without its rounding.
[[nodiscard]] Vector3 solid_inertia(const Shape& shape, double mass);
/// The axes of these moments, in body axes: its own but for a hull, a mesh or a compound.
[[nodiscard]] Quaternion solid_axes(const Shape& shape);
/// The box of a shape along the body's axes, about its origin (thesis, 3.3). A half-space has none:
/// throws.
[[nodiscard]] Box bounding_box(const Shape& shape);
/// The outward normal of a half-space in the world; `normal_B` itself where the pose is not turned.
[[nodiscard]] Vector3 half_space_normal(const HalfSpace& half_space, const Pose& pose);

}  // namespace core
}  // namespace kairos
