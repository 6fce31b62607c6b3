#pragma once

#include "core/contacts/flat_modes.hpp"

namespace kairos {
inline namespace core {

/// Whether friction acts between some two of the group.
[[nodiscard]] bool has_friction(const ContactGroup& group);

/// How a group with friction moves: `flat_mode` with Coulomb's friction. Each patch sticks (a ball
/// rolls), slides against a friction of mu N, or opens; bodies move on parabolas and do not turn,
/// but spheres do, at a rate that changes steadily.
///
/// The first proposal follows the velocities (sliding goes on, rest sticks); the next differ least
/// from it. A proposal is accepted if it can be verified: forces at the points of the patches, each
/// inside its cone, give every body its acceleration and turn none that must not (non-negative
/// least squares over the rays of the cones; of several solutions one is taken); patches that open
/// do not approach; patches that begin to slide accelerate against their friction. Each cone has 16
/// rays, and one along the force that is asked for. A patch that slides keeps its direction, or is
/// refused.
[[nodiscard]] FlatMode friction_mode(const ContactGroup& group, const FlatModeOptions& options);

/// The mode of a group with friction or without.
[[nodiscard]] FlatMode contact_mode(const ContactGroup& group, const FlatModeOptions& options);

}  // namespace core
}  // namespace kairos
