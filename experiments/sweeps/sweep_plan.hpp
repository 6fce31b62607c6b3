#pragma once

#include "core/reading/scene_reader.hpp"
#include "experiments/sweeps/sweep_spec.hpp"
#include "simulation/simulate.hpp"

#include <string>
#include <vector>

namespace kairos::experiments {

/// One run of a sweep, ready to go: a pure function of the spec and its index.
struct PlannedRun {
  std::size_t index = 0;
  std::size_t method = 0;              ///< into `SweepSpec::methods`
  std::size_t point = 0;               ///< combination of the listed axes, the same for all methods
  std::int64_t repeat = 0;             ///< of `SweepSpec::repeats`
  std::vector<AxisValue> axis_values;  ///< one per axis
  Values values;                       ///< what expressions see: constants, axes, repeat, repeats
  std::vector<Override> overrides;     ///< of the scene
  RunChoice choice;
  std::string refused;  ///< why it cannot even be tried; empty if it can
};

/// All runs: methods outermost, then axes in the order of the file, then repeats. Drawn values
/// depend on (seed, axis, point, repeat) and not on the method, so that methods are compared on the
/// same draws. Throws `InputError` for specs that cannot be meant: unknown schemes, wrong
/// expressions, more runs than 10 million.
[[nodiscard]] std::vector<PlannedRun> plan_sweep(const SweepSpec& spec);

/// The scene file of a sweep: a path relative to the spec, or the name of a scene of the project.
[[nodiscard]] std::string scene_path(const SweepSpec& spec);

}  // namespace kairos::experiments
