#pragma once

#include "core/force.hpp"
#include "core/gap_function.hpp"
#include "core/motion.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace kairos {
inline namespace core {

class Archive;

/// What a stepper is, and what it can do.
struct StepperInfo {
  std::string_view name;
  int order = 0;           ///< of the step, for smooth forces; 0: exact
  int position_order = 0;  ///< of the dense output's position; 0: exact
  int velocity_order = 0;  ///< of the dense output's velocity; 0: exact
  bool symplectic = false;
  bool controlled = false;   ///< chooses its own step within the one asked for
  std::string_view library;  ///< "kairos", "GSL", "SUNDIALS"
  std::string_view source;   ///< citation key of paper/references.bib
  /// Chooses its order too: `order` is the highest, and it takes no steps of fixed length.
  bool variable_order = false;
};

/// What a step came to.
struct StepResult {
  double advanced = 0.0;  ///< s; less than asked for only by controlled steppers, never 0 if ok
  double error = 0.0;     ///< estimated local error, in units of the tolerance; 0: none
  bool ok = true;
  std::string_view reason;          ///< of a failure
  JointProjection projection = {};  ///< at the end of the step, of islands with joints
};

/// One meaning of tolerance for all controlled steppers: the estimated local error of a step is at
/// most `absolute_tolerance + relative_tolerance |y|` in every component y of the state. An
/// infinite tolerance switches control off: each step is as long as asked for.
struct StepperOptions {
  double relative_tolerance = 1e-10;
  double absolute_tolerance = 1e-12;  ///< of positions (m) and velocities (m/s)
};

/// One body after a step in exact arithmetic (about 106 bits): unevaluated sums high + low.
struct ReplayedStep {
  Vector3 position_high = Vector3::Zero();  ///< m
  Vector3 position_low = Vector3::Zero();
  Vector3 velocity_high = Vector3::Zero();  ///< m/s
  Vector3 velocity_low = Vector3::Zero();
};

/// Port: moves the state of one island between impacts. Owns its memory (a lagged acceleration, a
/// multistep history); one instance per island, not shared between threads.
class Stepper {
 public:
  virtual ~Stepper() = default;
  /// What it is now: a closed form that has given up has another order.
  [[nodiscard]] virtual StepperInfo info() const = 0;

  /// Whether it can advance this island at all; a non-empty string is the reason why not.
  [[nodiscard]] virtual std::string refuses(const Island& island) const = 0;
  /// Starts at `states` (one per body of the island): forgets everything.
  virtual void start(const Island& island, Instant t, std::span<const BodyState> states) = 0;
  /// The state jumped (an impact, a field): forget what the jump made wrong, keep the rest.
  virtual void restart(const Island& island, Instant t, std::span<const BodyState> states) = 0;
  /// Advances the states from t by at most h > 0.
  virtual StepResult step(const Island& island, Instant t, double h,
                          std::span<BodyState> states) = 0;
  /// The last step as motions, one per body of the island. They end where `step` left the states,
  /// except that velocity may jump there (the thesis' Euler).
  virtual void dense_output(std::span<Motion> motions) const = 0;
  /// The last step again, from the states `before` it, in double-double: where its motions are at
  /// local time `s` (at most what the step advanced) if nothing is rounded. What the computed step
  /// differs by is roundoff. False, and `after` untouched, where that is not available: forces that
  /// are not constant. Translation only.
  virtual bool replay(const Island& /*island*/, double /*s*/, std::span<const BodyState> /*before*/,
                      std::span<ReplayedStep> /*after*/) const {
    return false;
  }
  /// Lets steps end where one of the gaps falls through zero, as far as the solver's own
  /// rootfinding sees it. False, and nothing changes, for steppers that have none. Before `start`.
  virtual bool watch(std::shared_ptr<const GapFunction> /*gaps*/) { return false; }
  /// Whether it holds the joints of an island by itself. All others see their forces, and are put
  /// back onto the constraints by `ConstrainedStepper`.
  [[nodiscard]] virtual bool holds_joints() const { return false; }
  /// Right-hand sides evaluated so far: the counted cost.
  [[nodiscard]] virtual std::int64_t evaluations() const = 0;
  /// Writes or reads all that the next step, the last step's dense output and the counted cost
  /// depend on; reading comes after `start` on the same island. False, and nothing done, where a
  /// foreign solver keeps its memory to itself: see `JournaledStepper`.
  virtual bool persist(Archive& /*archive*/) { return false; }
};

/// Makes one stepper per island.
using StepperFactory = std::unique_ptr<Stepper> (*)(const StepperOptions&);

}  // namespace core
}  // namespace kairos
