#pragma once

#include "core/state.hpp"

#include <optional>

namespace kairos::experiments {

/// A gas of hard balls between six walls, for a peer to step: elastic, no friction, no gravity.
struct GasTask {
  const State& start;
  double radius = 0.0;    ///< m, of each ball; the room is a cube of 1 m, a corner at the origin
  double mass = 1.0;      ///< kg, of each ball
  double duration = 0.0;  ///< s
  double frame = 0.0;     ///< s, of a step
};

/// What a peer makes of it.
struct GasOutcome {
  double seconds = 0.0;       ///< of the processor, for the steps
  double energy_ratio = 0.0;  ///< kinetic energy at the end over that at the start
  double deepest = 0.0;       ///< m: how deep two balls, or a ball and a wall, are in each other
};

/// ODE's quick step with its hash space; nothing where ODE was not found.
[[nodiscard]] std::optional<GasOutcome> ode_gas(const GasTask& task);

}  // namespace kairos::experiments
