#pragma once

#include "ccd/pair_motion.hpp"

namespace kairos::ccd {

/// What the direction of a separation is fixed to while time goes on.
enum class WitnessFrame {
  world,    ///< a direction that stays
  a,        ///< a direction that turns with a (a face of a)
  b,        ///< a direction that turns with b (a face of b, a half-space)
  edges,    ///< the cross product of an edge of a and an edge of b, which both turn
  spheres,  ///< a direction that stays, the bodies replaced by the balls around them
};

/// The direction along which two bodies are apart at one instant: the frozen witness.
struct Witness {
  WitnessFrame frame = WitnessFrame::world;
  Vector3 n = Vector3::UnitX();  ///< from a to b, world frame; of length `length`
  double length = 1.0;           ///< 1; for a cross product of edges the sine between them
  int edge_a = 0;                ///< `edges` only
  int edge_b = 0;                ///< `edges` only
  int axis = 0;                  ///< two boxes only: which of the 15 it is
  double sign = 1.0;             ///< two boxes only: as in `AxisSeparation`
  double gap = 0.0;              ///< separation along the unit direction, m
};

/// Which witness a pair of shapes needs.
enum class PairKind { sphere_sphere, sphere_box, sphere_plane, box_box, box_plane };

/// Signed gap of two moving shapes along a frozen witness, and how it can change:
///
///   f(h) = n(h) . d(h) - sum_k A_k |n(h) . a_k(h)| - sum_k B_k |n(h) . b_k(h)| - reach
///
/// with half extents A, B and axes a_k, b_k. f(h) > 0 proves that they are apart at t + h. A
/// quadratic below f comes from the exact first derivatives and bounds of the second ones
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
  /// From touch: the end of the time during which, after leaving, f > 0 is proven; 0 if it does not
  /// leave along this witness.
  [[nodiscard]] double advance_from_touch(double horizon) const;

 private:
  /// One term W |s + s' h|.
  struct Term {
    double weight = 0.0;
    double s = 0.0;
    double rate = 0.0;
  };

  void add_supports(const Vector3& half, const Matrix3& axes, const Vector3& g);
  void along_frame(const Vector3& w_frame);
  void along_edges();
  /// Slope of the sum of terms: the greatest at h = 0, or of the chord over [0, h].
  [[nodiscard]] double tangent() const;
  [[nodiscard]] double chord(double h) const;
  /// Coefficient of h^2 of the quadratic below f, valid on [0, horizon].
  [[nodiscard]] double curvature(double horizon) const;
  [[nodiscard]] bool curvature_depends_on_horizon() const {
    return witness_.frame != WitnessFrame::world && witness_.frame != WitnessFrame::spheres;
  }
  /// Does what the witness is fixed to turn at constant rates, while d is a parabola?
  [[nodiscard]] bool constant_rates() const {
    const bool with_a = witness_.frame == WitnessFrame::a || witness_.frame == WitnessFrame::edges;
    const bool with_b = witness_.frame == WitnessFrame::b || witness_.frame == WitnessFrame::edges;
    return turn_.bend == 0.0 && !(with_a && turn_.alpha_a > 0.0) &&
           !(with_b && turn_.alpha_b > 0.0);
  }
  /// The step that the quadratic on [0, reach] allows, at most `reach`.
  [[nodiscard]] double step_within(double reach) const;

  const PairMotion& motion_;
  const Kinematics& k_;
  const TurnBounds& turn_;
  const Witness& witness_;
  double value_ = 0.0;        ///< of the unnormalised gap, m
  double slope_ = 0.0;        ///< of n . d
  double second_ = 0.0;       ///< n . d: half its second derivative, where it is exact
  double fixed_bend_ = 0.0;   ///< what bounds the supports' second order, h-independent
  double least_slope_ = 0.0;  ///< of f at h = 0, rounding included
  double distance_ = 0.0;     ///< |d|, where the curvature asks for it
  double speed_ = 0.0;        ///< |v|
  double c_ = 0.0;            ///< |c|
  int count_ = 0;
  Term terms_[6];
};

[[nodiscard]] PairKind pair_kind(const Shape& a, const Shape& b);
/// The witness of the balls around the shapes (`gap` is negative infinity if there is none).
[[nodiscard]] Witness between_balls(PairKind kind, const PairMotion& motion, const Kinematics& k);
/// The same direction, of length 1 and fixed in the world, and the gap along it evaluated afresh:
/// of nearly parallel edges its rounding is not divided by their sine.
[[nodiscard]] Witness unit_in_world(const PairMotion& motion, const Kinematics& k,
                                    const Witness& witness);
/// A time up to which the balls around two bodies (the ball and a plane that does not turn) are
/// proven apart, whatever turns; 0 if they are not apart now, or if there are none. Costs no bound
/// of a rotation.
[[nodiscard]] double clear_of_balls(PairKind kind, const PairMotion& motion);
/// The witness of greatest separation; shapes in the order sphere, box, half-space.
[[nodiscard]] Witness find_witness(PairKind kind, const PairMotion& motion, const Kinematics& k);
/// Is the overlap of the shapes at this instant proven?
[[nodiscard]] bool proven_overlap(PairKind kind, const PairMotion& motion, const Kinematics& k,
                                  const Witness& witness);

}  // namespace kairos::ccd
