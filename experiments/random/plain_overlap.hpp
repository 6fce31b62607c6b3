#pragma once

#include "core/pose.hpp"
#include "core/shape.hpp"

namespace kairos::experiments {

/// How deep two shapes are inside each other, m; 0: not at all. By geometry of its own, in long
/// double and sharing nothing with the detectors: nearest points, and the fifteen axes of two boxes
/// [Gottschalk1996]; of other shapes at least so deep (`plain_parts_depth`). The judge of what
/// detectors answered.
[[nodiscard]] double plain_depth(const Shape& a, const Pose& pose_a, const Shape& b,
                                 const Pose& pose_b);

}  // namespace kairos::experiments
