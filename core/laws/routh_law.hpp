#pragma once

#include "core/impact_law.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// Impact with rotation and Coulomb's friction at one contact, as a motion in the normal impulse:
/// see `routh_impact`. Restitution is Stronge's. Belts (`Entity::surface_velocity`) carry.
[[nodiscard]] std::unique_ptr<ImpactLaw> make_routh_law();

/// What it does; the law `newton` does the same where there is friction.
[[nodiscard]] ImpactEnergy apply_routh(const Contact& contact, ImpactBody a, ImpactBody b);

}  // namespace core
}  // namespace kairos
