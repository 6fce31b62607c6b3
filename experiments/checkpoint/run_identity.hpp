#pragma once

#include "core/model.hpp"
#include "core/reading/scene_reader.hpp"
#include "experiments/checkpoint/checkpoint_file.hpp"
#include "simulation/simulate.hpp"

namespace kairos::experiments {

/// All that the bytes of a run depend on, but its duration: the scene (by what it says, not by
/// where its file lies), what was set, the options of the run, versions.
[[nodiscard]] RunIdentity run_identity(const Model& model, const std::vector<Override>& overrides,
                                       const RunChoice& choice);

}  // namespace kairos::experiments
