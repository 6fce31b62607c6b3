#pragma once

#include "core/drive.hpp"

namespace kairos {
inline namespace core {

/// A body that swings: p(t) = centre + amplitude sin(2 pi f t + phase), and about an axis by the
/// angle rotation_amplitude sin(2 pi f t + rotation_phase).
///
/// Motions are Taylor polynomials of degree 9 about their own start, at most 1/32 of a period long,
/// shorter for wide swings. Their error radius is proven: Lagrange's remainder, plus rounding. The
/// phase is taken from the `Instant` in double-double, so that a day later is as good as the start.
class Sinusoid : public Drive {
 public:
  struct Options {
    Pose centre;                              ///< where it swings about
    Vector3 amplitude = Vector3::Zero();      ///< m
    double frequency = 1.0;                   ///< Hz, > 0
    double phase = 0.0;                       ///< rad, at t = 0
    Vector3 rotation_axis = Vector3::Zero();  ///< unit, world frame; zero: does not turn
    double rotation_amplitude = 0.0;          ///< rad
    double rotation_phase = 0.0;              ///< rad
    double reach = 0.0;  ///< m; no point of the body is farther from its origin
  };

  explicit Sinusoid(const Options& options);

  [[nodiscard]] Motion motion(Instant t, double at_most) const override;
  [[nodiscard]] std::string description() const override;

 private:
  Options options_;
  bool turns_;
  double segment_;  ///< longest motion, s
};

}  // namespace core
}  // namespace kairos
