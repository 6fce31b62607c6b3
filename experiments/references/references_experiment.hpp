#pragma once

#include "experiments/sweeps/experiment_program.hpp"

namespace kairos::experiments {

/// Problems with known answers, by event-driven and by the schemes that people use.
[[nodiscard]] ProgramOutput run_references(const ExperimentSpec& spec, Size size,
                                           std::size_t threads);

}  // namespace kairos::experiments
