#pragma once

#include "core/ball_detector.hpp"

#include <optional>

namespace kairos::ccd {

/// Two spheres whose relative motion is uniform: at rest, or in the same gravity. Empty for any
/// other pair.
[[nodiscard]] std::optional<TimeOfImpact> sphere_sphere_impact(const MovingShape& a,
                                                               const MovingShape& b,
                                                               const Window& window);
/// Whether a query about this ball, which never ends, is one that `check_query` and `within_range`
/// let pass, for sure: what its coordinates may come to is taken from above.
[[nodiscard]] bool is_ordinary(const BallFlight& ball, const Window& window);
/// The same of two balls that never end, bit for bit; also empty where a query might have to be
/// refused.
[[nodiscard]] std::optional<TimeOfImpact> sphere_sphere_impact(const BallFlight& a,
                                                               const BallFlight& b,
                                                               const Window& window);
/// The same where they pass each other or meet, for who asks only when; empty also where they
/// might do neither.
[[nodiscard]] std::optional<BallMeeting> sphere_sphere_meeting(const BallFlight& a,
                                                               const BallFlight& b,
                                                               const Window& window);
/// When the two part.
[[nodiscard]] std::optional<TimeOfImpact> sphere_sphere_separation(const MovingShape& a,
                                                                   const MovingShape& b,
                                                                   const Window& window);

}  // namespace kairos::ccd
