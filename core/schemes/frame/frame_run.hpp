#pragma once

#include "core/schemes/shared/scheme_run.hpp"

#include <algorithm>
#include <vector>

namespace kairos {
inline namespace core {

/// What the parts of a frame-based run share: also where every body is now, and what forces it was
/// given in contacts.
struct FrameRun : SchemeRun {
  FrameRun(const Model& of, const Method& method, const SchemeOptions& asked, Recorder& to)
      : SchemeRun(of, method, asked, to),
        bodies(of.initial_state()),
        given_force(of.size(), Vector3::Zero()) {}

  /// Do the two overlap now?
  [[nodiscard]] bool touch(BodyIndex a, BodyIndex b) {
    ++cost.overlap_tests;
    return detector.overlaps(model.shape(a), bodies[a].pose, model.shape(b), bodies[b].pose);
  }
  /// Now something begins or ends between the two; their states do not jump.
  void tell(EventKind kind, BodyIndex a, BodyIndex b) {
    Event event{.time = time, .kind = kind, .a = a, .b = b};
    event.before_a = event.after_a = bodies[a];
    event.before_b = event.after_b = bodies[b];
    note(event);
  }
  void forget_given_forces() {
    if (any_given) {
      std::fill(given_force.begin(), given_force.end(), Vector3::Zero());
      any_given = false;
    }
  }
  void persist(Archive& archive) {
    archive(time, last_step, bodies, given_force, any_given, ledger, cost);
  }

  State bodies;
  std::vector<Vector3> given_force;  ///< N, by body; until the next step
  bool any_given = false;
  double last_step = 0.0;  ///< how long it was since everything moved, s
};

}  // namespace core
}  // namespace kairos
