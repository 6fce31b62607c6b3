#pragma once

#include "experiments/sweeps/experiment.hpp"

#include <string>

namespace kairos::experiments {

/// Runs what a spec says, its sweeps or its program, and leaves tables and figures in `folder`.
/// Throws `InputError` (an unknown program: with file, line and the names that exist) and
/// `RunError`.
ExperimentOutcome run_experiment(const ExperimentSpec& spec, const ExperimentOptions& options,
                                 const std::string& folder);

}  // namespace kairos::experiments
