#pragma once

#include "experiments/sweeps/experiment_program.hpp"
#include "experiments/tradeoff/assessment.hpp"

namespace kairos::experiments {

/// Assesses all sensible methods on each scene of the spec, then times them in turn.
[[nodiscard]] ProgramOutput run_tradeoff(const ExperimentSpec& spec, Size size,
                                         std::size_t threads);

/// The tables of some assessments: `SCENE_methods.csv`, `references.csv`, `fronts.csv`.
[[nodiscard]] ProgramOutput tradeoff_output(const std::vector<Assessment>& assessments,
                                            Table timings);

}  // namespace kairos::experiments
