#pragma once

#include "core/motion.hpp"
#include "core/state.hpp"

namespace kairos {
inline namespace simulation {

/// Between two states that are all that is known: a straight line at constant speed, a turn at
/// constant rate; velocities change evenly. `duration` > 0, s.
[[nodiscard]] Motion straight_motion(Instant start, double duration, const BodyState& from,
                                     const BodyState& to);

/// The same with the velocities of both ends (cubic Hermite): a parabola stays what it was.
[[nodiscard]] Motion smooth_motion(Instant start, double duration, const BodyState& from,
                                   const BodyState& to);

}  // namespace simulation
}  // namespace kairos
