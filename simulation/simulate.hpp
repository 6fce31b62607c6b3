#pragma once

#include "core/model.hpp"
#include "core/recorder.hpp"
#include "core/scheme.hpp"
#include "core/trajectory.hpp"

#include <memory>
#include <optional>
#include <string>

namespace kairos {
inline namespace simulation {

/// A simulation method by name: four independent choices, each with the same default whatever the
/// others are.
struct MethodChoice {
  std::string scheme = "event-driven";
  std::string integrator = "auto";
  std::string detector = "certified";
  std::string impact = "newton";

  /// The thesis' own: original, thesis-euler, sat, thesis.
  static MethodChoice thesis();
};

/// What a person may add to a scene and a method.
struct RunChoice {
  MethodChoice method = {};
  std::optional<FrameTimes> frames = {};  ///< instead of the scene's
  std::optional<double> duration = {};    ///< s, instead of the scene's
  std::optional<double> step = {};        ///< s, longest integrator step under `event-driven`
  StepperOptions stepper = {};
  double threshold = 0.0;  ///< m, see `SchemeOptions`
  bool equal_substeps = false;
  std::int64_t max_substeps = 100000;
  std::int64_t max_events = 0;  ///< of event-driven in one frame; 0: see `WorkBudget`
  double toi_tolerance = 0.0;   ///< m
  bool roundoff = false;
  TimeSteppingOptions stepping = {};  ///< of the schemes that step over contacts
  bool cold_restarts =
      false;  ///< steppers forget all they know at every impact, see the experiment
};

/// What a run that is interrupted leaves behind, and where it goes on from.
struct Continuation {
  CheckpointKeeper* keeper = nullptr;  ///< takes checkpoints; null: none are made
  std::string_view resume = {};        ///< what a keeper was given; empty: from the start
};

/// Plug-ins of one's own, in the place of those that a choice names; null: the named one.
struct PlugIns {
  std::shared_ptr<const Scheme> scheme = {};
  IslandStepperFactory integrator = {};  ///< makes a stepper for each island
  std::shared_ptr<const ContactDetector> detector = {};
  std::shared_ptr<const ImpactLaw> impact = {};
};

/// Resolves the names, refuses what cannot work (`InputError` with the reason), runs. A checkpoint
/// must be of the same model, choice and kind of recorder; throws `ArchiveError` where it is not
/// one. `--duration` alone may differ.
RunResult simulate(const Model& model, const RunChoice& choice, Recorder& recorder,
                   const Continuation& continuation = {}, const PlugIns& own = {});

/// The reason why this combination cannot run on this model; empty if it can.
[[nodiscard]] std::string why_refused(const Model& model, const RunChoice& choice,
                                      const PlugIns& own = {});

/// The shortest way: builds the model, runs, keeps everything in memory.
struct Simulation {
  RunResult result;
  Trajectory trajectory;
};
/// Throws `InputError` where the scene or the choice cannot work.
[[nodiscard]] Simulation simulate(const Scene& scene, const RunChoice& choice = {},
                                  const PlugIns& own = {});

}  // namespace simulation
}  // namespace kairos
