#pragma once

#include "core/contact_detector.hpp"

namespace kairos {
inline namespace core {

/// When two balls meet, for who asks no more. Times are local, as in `TimeOfImpact`.
struct BallMeeting {
  bool meets = false;
  double t_lo = 0.0;  ///< no contact in [0, t_lo), s
  double t_hi = 0.0;  ///< contact by then, s
  int evaluations = 0;
};

/// A detector that says so by being one: what it tells of balls, it tells sooner where it is asked
/// of nothing else, with the same bits.
class BallDetector {
 public:
  virtual ~BallDetector() = default;

  /// `ContactDetector::overlap` of two balls: where their centres are, and their radii, of which a
  /// scene may have such.
  [[nodiscard]] virtual Overlap ball_overlap(const Vector3& p_a, double radius_a,
                                             const Vector3& p_b, double radius_b) const = 0;
  /// `ContactDetector::ball_impact` where that is `separated` or `impact`; nothing: that has to be
  /// asked.
  [[nodiscard]] virtual std::optional<BallMeeting> ball_meeting(const BallFlight& a,
                                                                const BallFlight& b,
                                                                const Window& window) const = 0;
  /// `ContactDetector::time_of_impact` of a ball on a parabola without an error radius that never
  /// ends and of a half-space that is at rest there; nothing: that has to be asked.
  [[nodiscard]] virtual std::optional<TimeOfImpact> ball_meets_plane(
      const BallFlight& ball, const HalfSpace& half_space, const Pose& at_rest,
      const Window& window) const = 0;
};

}  // namespace core
}  // namespace kairos
