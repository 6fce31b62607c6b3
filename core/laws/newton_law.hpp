#pragma once

#include "core/impact_law.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// `newton`: Newton's restitution hypothesis for smooth rigid bodies, v_n' = -e v_n at the contact
/// point, the impulse along the contact normal [Stronge2000, ch. 3]. Face and edge contacts act
/// at the centroid of the contact patch, so that a box dropped flat returns flat. A pair that does
/// not approach is left as it is. Along the surface nothing acts, however that moves: without
/// friction a conveyor's belt does not carry, and is a wall.
[[nodiscard]] std::unique_ptr<ImpactLaw> make_newton_law();

}  // namespace core
}  // namespace kairos
