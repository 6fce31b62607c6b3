#pragma once

#include "experiments/physworld/story.hpp"

#include <cstdint>
#include <string>

namespace kairos::experiments {

struct SearchResult {
  std::string def;         ///< the scene; empty: none found
  std::int64_t tries = 0;  ///< worlds that were looked at
};

/// Looks for values that the thesis does not give, such that a run of `physworld.def` tells ch. 8.1
/// under `original` and under `event-driven` alike. Each try draws a world anew or changes the best
/// so far a little; once red has sent green off, the conveyor is put under green's way down. The
/// same seed, the same answer. `scene_path`: where the file is to be, which is where its models are
/// looked for.
[[nodiscard]] SearchResult search_physworld(std::uint64_t seed, std::int64_t most_tries,
                                            const std::string& scene_path);

}  // namespace kairos::experiments
