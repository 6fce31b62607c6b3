#pragma once

#include "simulation/simulate.hpp"
#include "simulation/view/view_run.hpp"

namespace kairos::experiments {

/// Runs a model for a page: its motions, events and energies, under the method's full name. A run
/// that stops is shown up to there, and says why.
[[nodiscard]] ViewRun simulated_view(const Model& model, const RunChoice& choice);

}  // namespace kairos::experiments
