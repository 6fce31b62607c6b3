#pragma once

#include "core/broad_phase.hpp"
#include "core/checkpoint.hpp"
#include "core/contact_detector.hpp"
#include "core/impact_law.hpp"
#include "core/neighbourhood.hpp"
#include "core/recorder.hpp"
#include "core/stepper.hpp"
#include "core/time_stepping_options.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace kairos {
inline namespace core {

/// Makes the stepper of an island: the one that was named, or what the `Model` chooses (`auto`).
using IslandStepperFactory =
    std::function<std::unique_ptr<Stepper>(const Model&, std::size_t island)>;
/// The box that a shape sweeps over a window of its motion, error radius included.
using SweptBounds = std::function<Aabb(const MovingShape&, const Window&)>;
/// Makes a broad phase for that many bodies.
using BroadPhaseFactory = std::function<std::unique_ptr<BroadPhase>(std::size_t bodies)>;

/// The choices of a method beside the scheme. A scheme sees them only through these ports.
struct Method {
  IslandStepperFactory stepper;
  std::shared_ptr<const ContactDetector> detector;
  std::shared_ptr<const ImpactLaw> law;
  BroadPhaseFactory broad_phase;
  SweptBounds swept_bounds;                 ///< what a broad phase is told
  NeighbourhoodFactory neighbourhood = {};  ///< the same where each body has a time of its own
  /// Makes the stepper of bodies that turn while they touch, whatever moves the others; empty:
  /// there is none. Its argument is the expected length of the first step, s.
  std::function<std::unique_ptr<Stepper>(double first_step)> contact_stepper = {};
};

/// What a run is told beside its method; `simulation/option.cpp` has ranges and meanings.
struct SchemeOptions {
  FrameTimes frames;            ///< how long rendered frames take
  double duration = 10.0;       ///< s
  double step = 0.0;            ///< s; longest integrator step under `event-driven`; 0: a frame
  double threshold = 0.0;       ///< m; fig. 15's largest movement; 0: half of the smallest extent
  bool equal_substeps = false;  ///< the mend of fig. 15: a frame in equal parts
  std::int64_t max_substeps = 100000;  ///< in one frame; more is refused with a reason
  std::int64_t max_events = 0;         ///< of event-driven in one frame; 0: see `WorkBudget`
  double toi_tolerance = 0.0;          ///< m; 0: the detector's default
  bool roundoff = false;               ///< replay steps in double-double for the ledger's roundoff
  TimeSteppingOptions stepping = {};   ///< of the schemes that step over contacts
  CheckpointKeeper* keeper = nullptr;  ///< takes checkpoints; null: none are made
  std::string_view resume = {};        ///< a checkpoint to go on from; empty: from the start
};

/// Counted work: what a run cost, whatever the machine.
struct Cost {
  std::int64_t frames = 0;
  std::int64_t steps = 0;  ///< integrator steps (substeps, segments)
  std::int64_t right_hand_sides = 0;
  std::int64_t overlap_tests = 0;
  std::int64_t toi_queries = 0;
  std::int64_t toi_evaluations = 0;
  std::int64_t contact_solves = 0;  ///< of one contact each, by what solves for contact impulses
  std::int64_t impacts = 0;
  std::int64_t events = 0;

  /// Writes it to a checkpoint, or reads it back.
  void persist(Archive& archive);
};

/// How a run ended.
enum class RunStatus {
  completed,
  stopped,  ///< before its end, with a reason; what was recorded is valid
};

/// What a run came to.
struct RunResult {
  RunStatus status = RunStatus::completed;
  std::string reason;  ///< of a stop: `accumulation: ...`, `still approaching: ...`
  Instant end;         ///< how far it got
  State state;         ///< there
  EnergyLedger ledger;
  Cost cost;
};

/// What a scheme is, and what it can do.
struct SchemeInfo {
  std::string_view name;
  std::string_view summary;
  std::string_view source;
  bool needs_location = false;  ///< needs a detector that locates
  bool friction = false;        ///< treats friction, where a scene has it
  /// The name of its own way to move bodies, if it has one. No other integrator then takes part in
  /// the run, and only `auto` or this name are accepted.
  std::string_view integrator = {};
  bool joints = false;    ///< holds bodies together where a scene has joints
  bool periodic = false;  ///< knows the images of bodies where a scene is periodic
};

/// When is the world looked at? Each scheme is one short main loop.
class Scheme {
 public:
  virtual ~Scheme() = default;
  /// The same for the whole life of the scheme.
  [[nodiscard]] virtual SchemeInfo info() const = 0;
  /// Why it cannot run this combination on this model; empty if it can.
  [[nodiscard]] virtual std::string refuses(const Model& model, const Method& method,
                                            const SchemeOptions& options) const = 0;
  /// Runs; call only what `refuses` does not refuse.
  virtual RunResult run(const Model& model, const Method& method, const SchemeOptions& options,
                        Recorder& recorder) const = 0;
};

}  // namespace core
}  // namespace kairos
