#pragma once

#include "core/pose.hpp"
#include "core/shape.hpp"

namespace kairos::experiments {

/// How deep two shapes of any kind are at least inside each other, m; 0: not shown to be. A
/// half-space is a. By Wolfe's algorithm for the point of least norm [Wolfe1976] in long double, on
/// all pairs of convex parts (triangles of meshes, parts of compounds): parts overlap where 0 is in
/// their Minkowski difference, and by a depth where they still do moved by so much along each axis,
/// to and fro. In a solid mesh a part is inside where the surface is seen under 4 pi from it: then
/// the depth is the size of the part.
[[nodiscard]] double plain_parts_depth(const Shape& a, const Pose& pose_a, const Shape& b,
                                       const Pose& pose_b);

}  // namespace kairos::experiments
