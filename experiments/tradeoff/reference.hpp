#pragma once

#include "experiments/tradeoff/measured_run.hpp"

#include <optional>
#include <string>
#include <vector>

namespace kairos::experiments {

/// What all methods are compared with on one scene.
struct Reference {
  std::string kind;       ///< "exact solution" or "event-driven, tightest"
  std::string sentence;   ///< how far and by what methods are compared, for a person
  double until = 0.0;     ///< s: methods run and are compared up to here
  double lyapunov = 0.0;  ///< s; 0: differences do not grow exponentially
  std::vector<std::optional<Vector3>> positions;    ///< at `until`, m; of free bodies
  std::map<BodyPair, std::vector<double>> impacts;  ///< times up to `until`, s
  double position_uncertainty = 0.0;                ///< m: two tolerances differ by this
  double time_uncertainty = 0.0;                    ///< s
  std::int64_t whole_impacts = 0;  ///< over the scene's whole duration: a statistic
  double whole = 0.0;              ///< s, that duration
  /// What kinds of bodies meet in the whole run and not up to `until`, as "ball and wall"; empty:
  /// what is compared shows all that happens.
  std::vector<std::string> unseen;
  /// m: how far the farthest free body is from where it began, up to `until`, and its size. What is
  /// farther off is no answer at all.
  double scale = 0.0;
};

/// Finds the reference of a model over `duration`. Throws `RunError` where there is none: the
/// reference itself is refused or stops at once.
[[nodiscard]] Reference find_reference(const Model& model, double duration);

/// How far a run is from the reference.
struct Errors {
  double position = 0.0;  ///< m, of the farthest free body at the end
  /// s, of the worst impact that both have; infinite where the run has none of a pair's.
  double event_time = 0.0;
  std::int64_t missed = 0;   ///< impacts of the reference that the run does not have
  double penetration = 0.0;  ///< m, deepest in a drawn frame
  double energy = 0.0;       ///< largest in a drawn frame, relative
};
[[nodiscard]] Errors errors_of(const MeasuredRun& run, const Reference& reference);

}  // namespace kairos::experiments
