#pragma once

#include "core/shape.hpp"
#include "core/time_of_impact.hpp"

namespace kairos::ccd {

/// The two questions about shapes at rest, for every combination.
/// Closed sets: touching is overlapping. Two half-spaces never meet.
[[nodiscard]] bool shapes_overlap(const Shape& a, const Pose& pose_a, const Shape& b,
                                  const Pose& pose_b);
/// Signed gap, normal from a to b, and centroid of the contact patch.
[[nodiscard]] Overlap measure_overlap(const Shape& a, const Pose& pose_a, const Shape& b,
                                      const Pose& pose_b);
/// The same of two spheres.
[[nodiscard]] Overlap measure_overlap_of_balls(const Vector3& p_a, double radius_a,
                                               const Vector3& p_b, double radius_b);

}  // namespace kairos::ccd
