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

/// Moves `t_lo` earlier, by ulps, until the shapes do not overlap at the poses of the motions.
void retreat_from_overlap(const MovingShape& a, const MovingShape& b, const Window& window,
                          TimeOfImpact& toi);

}  // namespace kairos::ccd
