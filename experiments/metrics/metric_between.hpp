#pragma once

#include "core/recorder.hpp"
#include "simulation/penetration.hpp"

#include <deque>
#include <vector>

namespace kairos::experiments {

/// Penetration where nobody looks: along the motions between drawn frames. A scheme that never
/// overlaps in a picture may still have gone through a wall between two.
class BetweenWatch {
 public:
  explicit BetweenWatch(const Model& model);
  void frame(const Frame& frame);
  void motion(BodyIndex body, const Motion& motion);

  /// Deepest penetration at `samples` instants between each two frames, m.
  [[nodiscard]] double max_depth() const { return max_depth_; }

 private:
  static constexpr int samples = 8;

  [[nodiscard]] BodyState state_at(BodyIndex body, Instant t) const;

  PenetrationProbe probe_;
  std::vector<std::deque<Motion>> motions_;  ///< that reach into the current frame
  State initial_;
  State sample_;
  bool drawn_ = false;
  Instant last_;
  double max_depth_ = 0.0;
};

}  // namespace kairos::experiments
