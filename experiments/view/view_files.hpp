#pragma once

#include "simulation/view/view_run.hpp"

#include <string>

namespace kairos::experiments {

/// Whether `path` is what `kairos run --out` wrote: a folder with a trajectory.csv, or that file.
[[nodiscard]] bool is_run(const std::string& path);

/// Reads a run from its files. They hold frames and events, not motions: between those, positions
/// follow the velocities of both ends (cubic Hermite, exact for a parabola), orientations turn at a
/// constant rate. Masses are not written, so impulses stay zero. Throws `InputError` with file,
/// line and column of what is missing or wrong.
[[nodiscard]] ViewRun read_run(const std::string& path);

}  // namespace kairos::experiments
