#pragma once

#include "core/pose.hpp"

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

/// What a body collides as: a closed set, visited once per query, outside every loop.
using Shape = std::variant<Sphere, Box, HalfSpace>;

[[nodiscard]] std::string_view shape_name(const Shape& shape);
/// Radius of the smallest ball around the origin that contains the shape, m (infinite: half-space).
[[nodiscard]] double bounding_radius(const Shape& shape);
/// Smallest full extent (a sphere's diameter, a box's thinnest side), m; infinite for a half-space.
[[nodiscard]] double smallest_extent(const Shape& shape);
/// Principal moments of inertia of the homogeneous solid about its origin, body axes, kg m^2.
[[nodiscard]] Vector3 solid_inertia(const Shape& shape, double mass);
/// The box of a shape along the body's axes (thesis, 3.3). A half-space has none: throws.
[[nodiscard]] Box bounding_box(const Shape& shape);
/// The outward normal of a half-space in the world; `normal_B` itself where the pose is not turned.
[[nodiscard]] Vector3 half_space_normal(const HalfSpace& half_space, const Pose& pose);

}  // namespace core
}  // namespace kairos
