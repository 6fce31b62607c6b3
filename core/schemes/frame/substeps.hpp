#pragma once

#include "core/schemes/frame/frame_world.hpp"

namespace kairos {
inline namespace core {

/// The threshold of fig. 15 that is meant when none is given: half of the smallest sum of the
/// extents of two bodies that can meet, m (infinite if nothing can).
[[nodiscard]] double default_threshold(const Model& model);

/// How far the next substep goes (fig. 15): the rest of the frame if no movement exceeds the
/// threshold, otherwise the fraction of it whose largest movement equals the threshold; with
/// `equal_substeps` the fraction of the *frame* that divides it into equal parts.
class SubstepPlan {
 public:
  SubstepPlan(const Model& model, const SchemeOptions& options);
  /// Forgets the last frame.
  void begin_frame(double frame);
  /// Length of the next substep, s, given that the world has proposed the `left` s of the frame
  /// that are left. Stops the world where a frame would take too many substeps: returns 0.
  [[nodiscard]] double next(FrameWorld& world, double left);

 private:
  double threshold_;
  bool equal_;
  std::int64_t most_;
  double frame_ = 0.0;
  double part_ = 0.0;  ///< of equal substeps, s
  std::int64_t taken_ = 0;
};

}  // namespace core
}  // namespace kairos
