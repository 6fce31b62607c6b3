#pragma once

#include "core/contacts/touch_rim.hpp"
#include "core/shape.hpp"

#include <optional>
#include <vector>

namespace kairos {
inline namespace core {

/// A convex piece of a face, body frame: what is inside all of its planes and, of the end of
/// something round, no further than `radius` from its axis.
struct FacePart {
  std::vector<TouchRim::Side> sides;
  double radius = 0.0;  ///< m; 0: it has no round rim
  Vector3 middle = Vector3::Zero();
  Vector3 axis = Vector3::Zero();  ///< unit
};

/// The pieces of the face with this outward normal that `at` is on (body frame): one of a convex
/// shape; of a mesh its triangles in that plane, of a compound the faces of its parts there. None:
/// the shape has no such face. Planes are one where they differ by roundoff.
[[nodiscard]] std::vector<FacePart> parts_of_face(const Shape& shape, const Vector3& outward,
                                                  const Vector3& at);

/// What of a shape rises above the plane of that face, as a surface where it is a mesh; nullopt:
/// nothing, as of all that is convex.
[[nodiscard]] std::optional<Shape> above_face(const Shape& shape, const Vector3& outward,
                                              const Vector3& at);

}  // namespace core
}  // namespace kairos
