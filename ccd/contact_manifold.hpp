#pragma once

#include "core/contact_manifold.hpp"
#include "core/shape.hpp"

namespace kairos::ccd {

/// The patch in which two shapes touch: its points whose gap is at most `reach` (m), none where the
/// shapes are further apart. Two faces of boxes share the corners of the one clipped by the side
/// planes of the other [Ericson2005, sec. 8.3.4]; a box has its lowest vertices above a half-space;
/// two edges, and any sphere, have one point.
[[nodiscard]] ContactManifold contact_manifold(const Shape& a, const Pose& pose_a, const Shape& b,
                                               const Pose& pose_b, double reach);

}  // namespace kairos::ccd
