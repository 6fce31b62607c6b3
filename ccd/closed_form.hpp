#pragma once

#include "core/contact_detector.hpp"

#include <optional>

namespace kairos::ccd {

/// Time of impact where the gap is a quadratic in time, whatever the spheres' spin: a sphere and a
/// half-space that does not turn, both moving on parabolas; two spheres under the same
/// acceleration. Windows may be infinite. Empty if the pair is not of that kind: the gap of every
/// other pair is advanced (`advance_to_impact`). Shapes in the order sphere, box, half-space.
///
/// At `t_lo` the bodies do not overlap, neither in real numbers nor as `shapes_overlap` sees them
/// at `motion.pose((window.start + t_lo) - motion.start)`.
[[nodiscard]] std::optional<TimeOfImpact> closed_form_impact(const MovingShape& a,
                                                             const MovingShape& b,
                                                             const Window& window);

/// The same pairs, overlapping at the start: when they part.
[[nodiscard]] std::optional<TimeOfImpact> closed_form_separation(const MovingShape& a,
                                                                 const MovingShape& b,
                                                                 const Window& window);

/// How often a retreat from an overlap of the poses may double: from an ulp of the time to half of
/// it and more. A second or less after the start an ulp of time is less than coordinates of 1e8 m
/// can show, so that it takes most of them.
inline constexpr int most_retreats = 64;

/// Moves `t_lo` earlier, by ulps doubled each time, until the shapes do not overlap at the poses of
/// the motions.
void retreat_from_overlap(const MovingShape& a, const MovingShape& b, const Window& window,
                          TimeOfImpact& toi);

}  // namespace kairos::ccd
