#pragma once

#include "core/schemes/shared/scheme_run.hpp"

#include <vector>

namespace kairos {
inline namespace core {

/// Fields (anti-gravity pads) under the schemes that step over contacts: what overlaps one when a
/// step begins feels its force for the whole step.
class StepFields {
 public:
  /// Puts the forces of all fields, N by body, into `given`, and tells what entered and left.
  void act(SchemeRun& run, const State& bodies, std::vector<Vector3>& given);
  void persist(Archive& archive, std::size_t bodies);

 private:
  struct Inside {
    BodyIndex field = 0, body = 0;
    bool seen = false;

    void persist(Archive& archive);
  };

  bool note(BodyIndex field, BodyIndex body);

  std::vector<Inside> inside_;
};

}  // namespace core
}  // namespace kairos
