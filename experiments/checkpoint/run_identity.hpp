#pragma once

#include "core/model.hpp"
#include "experiments/checkpoint/checkpoint_file.hpp"
#include "experiments/simulation.hpp"

namespace kairos::experiments {

/// All that the bytes of a run depend on, but its duration: scene (by what it says, not by where
/// its file lies), what was set, method, versions.
/// What of that is the method's, without what the scene says.
[[nodiscard]] RunIdentity method_identity(const RunChoice& choice);
[[nodiscard]] RunIdentity run_identity(const Model& model, const std::vector<Override>& overrides,
                                       const RunChoice& choice);

}  // namespace kairos::experiments
