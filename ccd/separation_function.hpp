#pragma once

#include "ccd/witness.hpp"

namespace kairos::ccd {

/// Signed gap of two moving shapes along a frozen witness, and how it can change:
///
///   f(h) = n(h) . d(h) - sum_k A_k |n(h) . a_k(h)| - sum_k B_k |n(h) . b_k(h)| - reach
///
/// with half extents A, B and axes a_k, b_k; of cores their supports take the place of the sums:
/// n . d - s_a(R_A' n) - s_b(-R_B' n) - reach. f(h) > 0 proves that they are apart at t + h. A
/// quadratic below f (eq. 9) comes from the exact first derivatives and bounds of the second ones
/// [Tang2009], [Zhang2006]; `advance` returns how far it stays positive.
class SeparationFunction {
 public:
  SeparationFunction(const PairMotion& motion, const Kinematics& k, const TurnBounds& turn,
                     const Witness& witness);

  /// Rate of the gap along the unit witness at h = 0; where a term has a kink, the least rate.
  [[nodiscard]] double rate() const;
  /// A time h <= horizon such that f > 0 on [0, h) is proven, rounding included; 0 if it is not
  /// positive now.
  [[nodiscard]] double advance(double horizon) const;
  /// The same from inside: f < 0 on [0, h). It proves an overlap where no other direction separates
  /// (a half-space).
  [[nodiscard]] double advance_inside(double horizon) const;
  /// From touch: the end of the time during which, after leaving, f > 0 is proven; 0 if it does not
  /// leave along this witness.
  [[nodiscard]] double advance_from_touch(double horizon) const;
  /// A lower bound of the gap along the witness on [0, reach], m.
  [[nodiscard]] double least_within(double reach) const;

 private:
  /// One term W |s + s' h|.
  struct Term {
    double weight = 0.0;
    double s = 0.0;
    double rate = 0.0;
  };

  /// The support of a core along m + m' h: convex in h, so that it is below its chord.
  struct CoreTerm {
    const ConvexCore* core = nullptr;
    Vector3 m;
    Vector3 rate;
    double support = 0.0;
  };

  /// What is round counts |n| times along edges: the growth of that, over h.
  struct Length {
    double crude = 0.0;  ///< m/s; holds for all h
    double rate = 0.0;   ///< m/s; at h = 0: with `bend`, m/s^2, holds up to the limit, s
    double bend = 0.0;
    double limit = 0.0;

    [[nodiscard]] double slope(double h) const { return h <= limit ? rate : crude; }
    [[nodiscard]] double second(double h) const { return h <= limit ? bend : 0.0; }
  };

  void add_supports(const Vector3& half, const Matrix3& axes, const Vector3& g);
  /// `side`: 1 for a, whose support is along n, -1 for b. g: the rate of n seen from the body.
  void add_core(const ConvexCore& core, const Matrix3& R, double side, const Vector3& g);
  [[nodiscard]] bool has_terms() const { return count_ + core_count_ > 0; }
  void along_frame(const Vector3& w_frame);
  void along_edges();
  /// Slope of the sum of terms: the greatest at h = 0, or of the chord over [0, h].
  [[nodiscard]] double tangent() const;
  [[nodiscard]] double chord(double h) const;
  /// Half the second derivative of n . d as far as it is exact, and a bound of what is unknown of
  /// that of f on [0, horizon].
  [[nodiscard]] double known_curvature() const {
    return !direction_turns() || constant_rates() ? second_ : 0.0;
  }
  [[nodiscard]] double unknown_curvature(double horizon) const;
  /// Coefficient of h^2 of the quadratic below f, valid on [0, horizon].
  [[nodiscard]] double curvature(double horizon) const;
  /// Does the direction turn? The quadratic below f then depends on the horizon.
  [[nodiscard]] bool direction_turns() const {
    return witness_.frame != WitnessFrame::world && witness_.frame != WitnessFrame::hulls;
  }
  /// Does what the witness is fixed to turn at constant rates, while d is a parabola?
  [[nodiscard]] bool constant_rates() const {
    const bool with_a = witness_.frame == WitnessFrame::a || witness_.frame == WitnessFrame::edges;
    const bool with_b = witness_.frame == WitnessFrame::b || witness_.frame == WitnessFrame::edges;
    return turn_.bend == 0.0 && !(with_a && turn_.alpha_a > 0.0) &&
           !(with_b && turn_.alpha_b > 0.0);
  }
  /// The longest horizon worth a look.
  [[nodiscard]] double first_reach(double horizon) const;
  /// The step that the quadratic on [0, reach] allows, at most `reach`.
  [[nodiscard]] double step_within(double reach) const;

  const PairMotion& motion_;
  const Kinematics& k_;
  const TurnBounds& turn_;
  const Witness& witness_;
  double scale_ = 1.0;         ///< length of n: f is so many times the gap
  double value_ = 0.0;         ///< of f less its error, m
  double error_ = 0.0;         ///< of f, m
  double rate_error_ = 0.0;    ///< of its slope, m/s
  double second_error_ = 0.0;  ///< of the coefficient of h^2, m/s^2
  double slope_ = 0.0;         ///< of n . d
  double second_ = 0.0;        ///< n . d: half its second derivative, where it is exact
  double fixed_bend_ = 0.0;    ///< what bounds the supports' second order, h-independent
  double least_slope_ = 0.0;   ///< of f at h = 0, rounding included
  double distance_ = 0.0;      ///< |d|, where the curvature asks for it
  double speed_ = 0.0;         ///< |v|
  double c_ = 0.0;             ///< |c|
  Length length_;
  int count_ = 0;
  Term terms_[6];
  int core_count_ = 0;
  CoreTerm cores_[2];
};

}  // namespace kairos::ccd
