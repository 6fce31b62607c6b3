#pragma once

#include "ccd/body_parts.hpp"
#include "core/contact_manifold.hpp"
#include "core/time_of_impact.hpp"

#include <vector>

namespace kairos::ccd {

// Two shapes at rest of which one has parts (a mesh, a compound); a half-space is b.

/// Do they overlap, touching included? Of two meshes exactly (see ccd/mesh); otherwise as the
/// separations that were found say, rounding aside. Solids also overlap where one is inside.
[[nodiscard]] bool parts_overlap(const Shape& a, const Pose& pose_a, const Shape& b,
                                 const Pose& pose_b);
/// The gap is that of the two parts that are nearest, or deepest in each other: of surfaces in each
/// other, whose depth nobody has defined, it is what those parts have to be moved by. One inside
/// the other, apart from its surface: the distance of the surfaces, negative.
[[nodiscard]] Overlap measure_parts(const Shape& a, const Pose& pose_a, const Shape& b,
                                    const Pose& pose_b);
/// Of all parts that are as near along the normal of the nearest ones.
[[nodiscard]] ContactManifold parts_manifold(const Shape& a, const Pose& pose_a, const Shape& b,
                                             const Pose& pose_b, double reach);
/// Is one inside the other, a solid, so that their surfaces are apart or cross nowhere?
[[nodiscard]] bool one_inside(const Shape& a, const Pose& pose_a, const Shape& b,
                              const Pose& pose_b);
/// The middle of where they touch, halfway between them, of parts whose gap along the unit normal n
/// is `gap` and at most `within` more, world, m.
[[nodiscard]] Vector3 touching_point(const Shape& a, const Pose& pose_a, const Shape& b,
                                     const Pose& pose_b, const Vector3& n, double gap,
                                     double within);

}  // namespace kairos::ccd
