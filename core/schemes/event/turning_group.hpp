#pragma once

#include "core/contacts/turning_step.hpp"
#include "core/schemes/event/event_modes.hpp"

namespace kairos {
inline namespace core {

/// A group that turns, as it is settled.
struct EventModes::Turning {
  TurningGroup group;
  TurningMode mode;
  TurningStep step;

  [[nodiscard]] EventMotions::Turn turn_of(std::size_t place) const {
    EventMotions::Turn turn{step.motions[place], step.states[place], step.worked[place]};
    const auto& inertia = group.inertia;
    const auto first = std::find_if(inertia.begin(), inertia.end(),
                                    [](const BodyInertia& i) { return i.mass > 0.0; });
    if (static_cast<std::size_t>(first - inertia.begin()) == place) {
      turn.worked.resize(std::max(turn.worked.degree(), step.leaked.degree()));
      for (int k = 0; k <= step.leaked.degree(); ++k) {
        turn.worked[k].y() = step.leaked[k].x();
      }
    }
    return turn;
  }
};

}  // namespace core
}  // namespace kairos
