#pragma once

#include "experiments/sweeps/experiment_program.hpp"

namespace kairos::experiments {

/// Which question costs what: the counted work of every query on shapes and meshes, the times of
/// those libraries that were found, and the questions of the systems that the thesis reviews.
[[nodiscard]] ProgramOutput run_queries(const ExperimentSpec& spec, Size size, std::size_t threads);

}  // namespace kairos::experiments
