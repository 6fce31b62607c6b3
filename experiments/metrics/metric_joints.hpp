#pragma once

#include "core/model.hpp"
#include "core/recorder.hpp"

#include <vector>

namespace kairos::experiments {

/// How well joints hold: their residuals in drawn frames.
class JointWatch {
 public:
  explicit JointWatch(const Model& model);
  void frame(const Frame& frame);

  /// Largest residual so far, of any joint, relative to the size of its mechanism; 0 without
  /// joints.
  [[nodiscard]] double max_drift() const { return max_drift_; }

 private:
  std::vector<const Island*> islands_;  ///< with joints
  std::vector<BodyState> states_;       ///< of one of them
  double max_drift_ = 0.0;
};

}  // namespace kairos::experiments
