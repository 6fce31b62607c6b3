#pragma once

#include "core/contact_manifold.hpp"
#include "core/shape.hpp"
#include "core/time_of_impact.hpp"

namespace kairos::ccd {

// Two shapes at rest of which one is a capsule, a cylinder, a cone or a hull; a half-space is b.

/// Do they overlap, touching included? As the separation that was found says, rounding aside.
[[nodiscard]] bool cores_overlap(const Shape& a, const Pose& pose_a, const Shape& b,
                                 const Pose& pose_b);
/// Signed gap (m; negative: depth), unit normal from a to b and centroid of the contact patch,
/// world.
[[nodiscard]] Overlap measure_cores(const Shape& a, const Pose& pose_a, const Shape& b,
                                    const Pose& pose_b);
/// Points of the contact patch whose gap is at most `reach` (m), world frame.
[[nodiscard]] ContactManifold core_manifold(const Shape& a, const Pose& pose_a, const Shape& b,
                                            const Pose& pose_b, double reach);

/// Between which numbers their distance is, proven, m; both 0: they are proven to overlap.
struct DistanceBounds {
  double lower = 0.0;
  double upper = 0.0;
  Vector3 on_a =
      Vector3::Zero();  ///< points of both, at most `upper` apart but for rounding, world
  Vector3 on_b = Vector3::Zero();
};
/// The distance of any two shapes but half-spaces.
[[nodiscard]] DistanceBounds distance(const Shape& a, const Pose& pose_a, const Shape& b,
                                      const Pose& pose_b);
/// How far they have to be moved to part, at least and at most, m; both 0: they are proven apart.
struct DepthBounds {
  double lower = 0.0;
  double upper = 0.0;
  Vector3 normal = Vector3::UnitX();  ///< along which b parts from a by `upper`, world
};
/// The depth of any two shapes but half-spaces.
[[nodiscard]] DepthBounds depth(const Shape& a, const Pose& pose_a, const Shape& b,
                                const Pose& pose_b);

}  // namespace kairos::ccd
