#pragma once

#include "core/contacts/flat_modes.hpp"

namespace kairos {
inline namespace core {

/// Whether friction acts between some two of the group.
[[nodiscard]] bool has_friction(const ContactGroup& group);

/// How a group goes on that rubs: `flat_mode` with Coulomb's friction. Each patch sticks (a ball
/// rolls), slides against a friction of mu N, or opens; bodies move on parabolas and do not turn,
/// but spheres do, at a rate that changes steadily.
///
/// Proposed is what the velocities say (what slides slides, what rests sticks), then what differs
/// least from it. Accepted is what was verified: forces at the points of the patches, each inside
/// its cone, that give every body its acceleration and turn none that must not (non-negative least
/// squares over the rays of the cones; where many forces do, one of them is taken); what opens
/// does not approach; what begins to slide accelerates against its friction. Of a cone 16 rays are
/// taken, and the one along the force that is asked for. A patch that slides keeps its direction,
/// or is refused.
[[nodiscard]] FlatMode friction_mode(const ContactGroup& group, const FlatModeOptions& options);

/// The mode of a group with friction or without.
[[nodiscard]] FlatMode contact_mode(const ContactGroup& group, const FlatModeOptions& options);

}  // namespace core
}  // namespace kairos
