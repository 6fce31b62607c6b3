#pragma once

#include "experiments/random/tally.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace kairos::experiments {

/// Of what kind random scenes are.
enum class SceneKind {
  any,       ///< `random_scene`
  touching,  ///< `touching_scene`
  rough,     ///< `rough_scene`
  jointed,   ///< `jointed_scene`
  shapes,    ///< `shapes_scene`
  balls,     ///< `balls_scene`
};
/// The word that asks for it: "" for any.
[[nodiscard]] std::string_view to_string(SceneKind kind);

/// Which random scenes are to be run.
struct SceneSurvey {
  std::uint64_t count = 1000;
  std::uint64_t seed = 1;
  std::uint64_t first = 0;
  SceneKind kind = SceneKind::any;
  std::size_t threads = 0;  ///< 0: one per core; results do not depend on it
};

/// One of its scenes.
[[nodiscard]] RandomScene scene_of(const SceneSurvey& survey, std::uint64_t number);

/// Runs them in blocks. `journal`: a file that keeps finished blocks, from which a survey that was
/// killed, or wants more scenes, goes on; empty: none. `progress` is told the tally so far after
/// each block, one call at a time.
[[nodiscard]] Tally run_survey(const SceneSurvey& survey, const std::string& journal,
                               const std::function<void(const Tally&)>& progress);

/// As JSON: what was run, what it came to, which scenes failed.
[[nodiscard]] std::string survey_summary(const SceneSurvey& survey, const Tally& tally);

}  // namespace kairos::experiments
