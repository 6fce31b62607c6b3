#pragma once

#include "ccd/convex_core.hpp"
#include "core/contact_detector.hpp"

namespace kairos::ccd {

/// Two moving shapes at one instant of a window, world frame: what a separation function and its
/// rate are made of. Shapes are rounded boxes: a ball is a box of extent 0 and its radius; where
/// one of a pair is a capsule, a cylinder, a cone or a hull, both are rounded cores.
struct Kinematics {
  double t = 0.0;  ///< window time, s
  Vector3 d;       ///< origin of b from the origin of a, m
  Vector3 v;       ///< its rate, m/s
  Vector3 c;       ///< d(t + h) = d + v h + c h^2, up to `TurnBounds::bend` h^2, m/s^2
  Matrix3 R_WA;    ///< columns: axes of a
  Matrix3 R_WB;    ///< of a half-space: `R_WB.col(1)` is its normal
  Vector3 w_a;     ///< angular velocities, rad/s
  Vector3 w_b;
  double error = 0.0;               ///< bound of the rounding error of any separation, m
  double rate_error = 0.0;          ///< the same of its rate, m/s
  double second_error = 0.0;        ///< the same of half its second derivative, m/s^2
  double still_rate_error = 0.0;    ///< of the rate along a direction that stays, of hulls that do
  double still_second_error = 0.0;  ///< not turn, m/s and m/s^2
};

/// The same with time running backwards: where the bodies come from.
[[nodiscard]] Kinematics reversed(const Kinematics& k);

/// Bounds of what `Kinematics` does not say, valid from its time until `until`.
struct TurnBounds {
  double until = 0.0;
  double w_a = 0.0, w_b = 0.0;          ///< angular speeds, rad/s
  double alpha_a = 0.0, alpha_b = 0.0;  ///< angular accelerations, rad/s^2
  double bend = 0.0;                    ///< of d: |d'' - 2 c| <= 2 bend, m/s^2
};

/// Bounds on an interval that ends at the time of the kinematics, for those that run backwards.
[[nodiscard]] TurnBounds reversed(const TurnBounds& turn);

/// What of the positions is kept against a half-space that is tilted and does not turn.
enum class Positions {
  whole,    ///< as everywhere
  heights,  ///< only the height above it, in twice the precision: `Kinematics::d` is along its
            ///< normal
};

/// A core and how its body moves: of a whole body, or of a part of it.
struct MovingCore {
  const ConvexCore& core;
  const Motion& motion;
};

/// The two motions of a query, in window time.
class PairMotion {
 public:
  PairMotion(const MovingCore& a, const MovingCore& b, const Window& window);
  /// b is a half-space.
  PairMotion(const MovingCore& a, const MovingShape& b, const Window& window, Positions positions);
  PairMotion(const MovingShape& a, const MovingShape& b, const Window& window,
             Positions positions = Positions::whole);

  [[nodiscard]] double duration() const { return duration_; }
  /// Half extents of the rounded boxes (0 for spheres and half-spaces).
  [[nodiscard]] const Vector3& half_a() const { return half_a_; }
  [[nodiscard]] const Vector3& half_b() const { return half_b_; }
  /// Are the bodies cores? Against a half-space only a is one.
  [[nodiscard]] bool has_cores() const { return has_cores_; }
  [[nodiscard]] const ConvexCore& core_a() const { return core_a_; }
  [[nodiscard]] const ConvexCore& core_b() const { return core_b_; }
  /// Radii of the balls around the boxes or cores.
  [[nodiscard]] double radius_a() const { return radius_a_; }
  [[nodiscard]] double radius_b() const { return radius_b_; }
  /// Sphere radii and error radii: what every separation is lowered by.
  [[nodiscard]] double reach() const { return reach_; }
  /// Its part that is error radii.
  [[nodiscard]] double error_reach() const { return error_reach_; }
  /// Does the orientation of a (b) matter and change?
  [[nodiscard]] bool turns_a() const { return turns_a_; }
  [[nodiscard]] bool turns_b() const { return turns_b_; }
  /// True if d is a parabola and both rates of turn are constant: bounds then hold for ever.
  [[nodiscard]] bool simple() const { return simple_; }
  /// How far d is from a parabola on [t, t1]: see `TurnBounds::bend`, m/s^2.
  [[nodiscard]] double bend(double t, double t1) const;

  /// Other parts of the same bodies, within the cores that it was made of: `Kinematics` stay what
  /// they are, and their errors hold for the parts.
  void take_parts(const ConvexCore& a, const ConvexCore& b);

  void evaluate(double t, Kinematics& k) const;
  /// Only what does not depend on orientations: t, d, v, c; the errors are those of the distance of
  /// the origins.
  void evaluate_translation(double t, Kinematics& k) const;
  /// Bounds on [t, t + horizon] (cut at the end of the window).
  [[nodiscard]] TurnBounds bounds(double t, double horizon) const;
  /// True if a (b) turns at a constant rate.
  [[nodiscard]] bool spins_a() const { return turns_a_ && rate_a_ > 0.0; }
  [[nodiscard]] bool spins_b() const { return turns_b_ && rate_b_ > 0.0; }
  /// Upper bound of the speed of any point of b against any point of a on [t, t + horizon], m/s.
  [[nodiscard]] double speed_bound(const Kinematics& k, const TurnBounds& turn,
                                   double horizon) const;
  /// Upper bound of the acceleration of any point of b against any point of a, as far as turning
  /// goes on [t, t + horizon] and for origins in the rest of the window, m/s^2.
  [[nodiscard]] double acceleration_bound(const Kinematics& k, double horizon) const;
  /// When `length` is covered at `speed` and what bends the motions, s; infinite or NaN: never. (A
  /// pair that hardly approaches may be through each other by the time that its speed alone would
  /// take.)
  [[nodiscard]] double time_to_cover(double length, double speed, const Kinematics& k) const;

 private:
  PairMotion(const Motion& a, const Motion& b, const Window& window);
  void set_cores(const ConvexCore& a, const ConvexCore* b);
  void set_plane(const HalfSpace& half_space);
  /// What depends on the motions, once shapes or cores are set.
  void finish(Positions positions);
  void subtract_positions();
  void subtract_heights();
  void add_rotation_errors();

  const Motion* motion_a_;
  const Motion* motion_b_;
  double s_a_;  ///< local time of a at the start of the window
  double s_b_;
  double rate_a_ = 0.0;  ///< of a constant turn, rad/s
  double rate_b_ = 0.0;
  double duration_;
  Vector3 half_a_ = Vector3::Zero();
  Vector3 half_b_ = Vector3::Zero();
  ConvexCore core_a_;
  ConvexCore core_b_;
  bool has_cores_ = false;
  double extent_a_ = 0.0;  ///< what roundings of a are parts of: sum of its half extents, m
  double extent_b_ = 0.0;
  double radius_a_ = 0.0;
  double radius_b_ = 0.0;
  double reach_ = 0.0;
  double error_reach_ = 0.0;
  Vector3 normal_b_ = Vector3::UnitY();  ///< of a half-space, in the frame of b
  bool plane_b_ = false;
  bool oriented_a_ = false;  ///< the orientation matters: a box or a half-space
  bool oriented_b_ = false;
  bool turns_a_ = false;
  bool turns_b_ = false;
  bool simple_ = true;
  bool constant_rates_ = true;  ///< of turning
  Polynomial<3> d_;
  Polynomial<3> curvature_;  ///< d'' / 2, degree > 2 only
  std::array<double, Polynomial<3>::max_degree + 1> position_error_{};  ///< coefficients in t
  double rotation_error_ = 0.0;  ///< of the entries of both rotation matrices
  /// What an angle of a (b) is off by at the start, and its growth with time, 1/s: beside that.
  double angle_error_a_ = 0.0, angle_error_rate_a_ = 0.0;
  double angle_error_b_ = 0.0, angle_error_rate_b_ = 0.0;
};

}  // namespace kairos::ccd
