#pragma once

#include "core/schemes/frame/frame_motions.hpp"
#include "core/schemes/shared/grasps.hpp"

namespace kairos {
inline namespace core {

/// Hands that hold, for the schemes that look at the world at given times (7.5): fists close and
/// open at these times. What was held since the last look has been where its hand is; a body that
/// is let go starts there.
class FrameHands {
 public:
  FrameHands(FrameRun& run, FrameMotions& motions, Grasps& grasps)
      : run_(run), motions_(motions), grasps_(grasps) {}

  void follow();

 private:
  void carry(const Grip& grip, double share);
  void check_free(const Grip& grip);

  FrameRun& run_;
  FrameMotions& motions_;
  Grasps& grasps_;
};

}  // namespace core
}  // namespace kairos
