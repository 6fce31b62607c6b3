#pragma once

#include "core/contacts/turning_step.hpp"
#include "core/schemes/event/event_modes.hpp"

namespace kairos {
inline namespace core {

/// How much is tried with groups that turn.
struct TurningLimits {
  /// So many short steps in a row get nowhere.
  static constexpr int most_short_steps = 1500;
  /// After so many of them steps are implicit: what slides turns its direction, or stops, within
  /// what such a step cannot tell.
  static constexpr int few_short_steps = 50;
  /// One that ends where it begins, since its forces do not hold, counts as so many short ones.
  static constexpr int of_stall = 10;
  /// Forces at an instant are looked for of so many free bodies that turn: of more they are found
  /// too slowly.
  static constexpr std::ptrdiff_t most_bodies = 24;
  /// A body that turns has so many steps in a frame at most.
  static constexpr int most_steps = 10000;
  /// After so many its hops count as rest below half of what counts as touch.
  static constexpr int many_steps = 1000;
  /// Searches for forces that found none are halved so many times at most: to a hundred solves.
  static constexpr int most_halvings = 5;
};

/// A group that turns, as it is settled.
struct EventModes::Turning {
  TurningGroup group;
  TurningMode mode;
  TurningStep step;
  bool all = false;          ///< what is in touch is kept for the step, pressed or not
  std::vector<char> jammed;  ///< by touch: friction stopped it by an impulse; empty: none
  double driven = 0.0;       ///< work of what joints hang on, before that of the mode, J

  [[nodiscard]] EventMotions::Turn turn_of(std::size_t place) const {
    EventMotions::Turn turn{step.motions[place], step.states[place], step.worked[place]};
    const Polynomial<3>& leaked = step.leaked[place];
    turn.worked.resize(std::max(turn.worked.degree(), leaked.degree()));
    for (int k = 0; k <= leaked.degree(); ++k) {
      turn.worked[k].y() = leaked[k].x();
    }
    const Polynomial<3>& of_driver = step.driven[place];
    for (int k = 0; k <= of_driver.degree(); ++k) {
      turn.worked[k].z() = of_driver[k].x();
    }
    return turn;
  }
};

/// The states of those that are free, in order.
inline std::vector<BodyState> free_states(const TurningGroup& group) {
  std::vector<BodyState> states;
  for (std::size_t i = 0; i < group.bodies.size(); ++i) {
    if (group.inertia[i].mass > 0.0) {
      states.push_back(group.start.states[i]);
    }
  }
  return states;
}

}  // namespace core
}  // namespace kairos
