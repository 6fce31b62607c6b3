#pragma once

#include "experiments/sweeps/sweep_spec.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace kairos::experiments {

/// How far the shards of a sweep are, wherever they run: what their folders hold.
struct SweepProgress {
  std::size_t finished = 0;  ///< shards
  std::size_t begun = 0;     ///< shards that have rows and are not finished: at work, or killed
  std::size_t rows = 0;      ///< runs whose rows are there
  std::size_t runs = 0;      ///< of the whole sweep
};

/// Looks at folders of shards, or folders of such folders, while others write to them. Shards are
/// not compared with the spec; merging does that. Throws `InputError` for what is no folder.
[[nodiscard]] SweepProgress progress_of(const ExperimentSpec& spec,
                                        const std::vector<std::string>& folders);

}  // namespace kairos::experiments
