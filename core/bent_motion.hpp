#pragma once

#include "core/motion.hpp"
#include "core/state.hpp"

namespace kairos {
inline namespace core {

/// Bends a motion of duration h, s, that begins and ends nearly at two states so that it does
/// exactly: positions and quaternions by cubics, which change at the ends as the velocities do, and
/// velocities by straight lines.
void bend_to(Motion& motion, double h, const BodyState& before, const BodyState& after);

}  // namespace core
}  // namespace kairos
