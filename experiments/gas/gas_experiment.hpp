#pragma once

#include "experiments/sweeps/experiment_program.hpp"

namespace kairos::experiments {

/// A gas of hard bodies against what is known of it: pressure, time between impacts, diffusion of
/// balls at three fractions in a periodic box (`fluid.csv`, `pairs.csv`); how boxes share their
/// energy (`shares.csv`); and what schemes that step by frames make of a gas between walls
/// (`schemes.csv`, their time in `timings.csv`).
[[nodiscard]] ProgramOutput run_gas(const ExperimentSpec& spec, Size size, std::size_t threads);

}  // namespace kairos::experiments
