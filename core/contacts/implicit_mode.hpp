#pragma once

#include "core/contacts/turning_mode.hpp"

#include <span>

namespace kairos {
inline namespace core {

/// Contact forces on the average of a step of `h`, s, implicit in the velocities at its end:
/// Moreau's step [Moreau1988, Jean1999], where no forces are known at an instant, or what slides is
/// so slow that its direction turns within what a step can tell. No normal rate at the end is below
/// 0, what presses does not part, and each impulse is within its cone, against what still slides at
/// the end [Jourdan1998]: touch by touch, again and again, from `warm` on (forces by touch, N;
/// empty: from none). Velocities at the start keep no approach. Of first order in h, and of second
/// with what was missed.
/// @param last_resort  where sweeps do not settle, what is rough is held along the surfaces by what
///                     does not press it, too, unless it parts
/// @param halvings  the most sweeps are halved so many times
/// @param missed  by touch: by how much velocities at the end were missed with such impulses, m/s;
///                empty: by nothing
///
/// Joints pass on what touches do; loads are with them. A refusal where sweeps do not settle.
[[nodiscard]] TurningMode implicit_mode(const TurningState& state, double h,
                                        std::span<const Vector3> warm, bool last_resort = false,
                                        int halvings = 0, std::span<const Vector3> missed = {});

}  // namespace core
}  // namespace kairos
