#pragma once

#include "ccd/pair_motion.hpp"

namespace kairos::ccd {

/// Bounds of the motion ahead of a look. Where both bodies turn at constant rates on parabolas they
/// hold for the whole window; those of polynomials hold on a piece, which follows the steps.
class BoundsAhead {
 public:
  /// The motion must outlive it.
  explicit BoundsAhead(const PairMotion& motion) : motion_(motion) {}

  /// Anew, on [t, t + piece].
  void begin(double t, double piece);
  /// Before the step from t, when the last step was so long (s; 0: there was none): a piece of four
  /// steps, made anew where it has ended or is 16 steps too long.
  void renew(double t, double last_step);

  [[nodiscard]] const TurnBounds& turn() const { return turn_; }
  /// Until when they hold, window time, s.
  [[nodiscard]] double until() const { return turn_.until; }
  /// Angular speed of bodies that turn at constant rates, rad/s.
  [[nodiscard]] double spin() const {
    return (motion_.spins_a() ? turn_.w_a : 0.0) + (motion_.spins_b() ? turn_.w_b : 0.0);
  }

 private:
  const PairMotion& motion_;
  TurnBounds turn_;
  double made_at_ = 0.0;  ///< s
  bool used_again_ = false;
};

}  // namespace kairos::ccd
