#pragma once

#include "core/instant.hpp"
#include "core/polynomial.hpp"
#include "core/pose.hpp"

namespace kairos {
inline namespace core {

/// How the orientation of a `Motion` changes.
enum class RotationKind {
  fixed,          ///< q(s) = q_0
  constant_rate,  ///< q(s) = exp(w s / 2) q_0, w = `rotation_rate`
  polynomial,     ///< q(s) = Q(s) / |Q(s)|, Q a polynomial in R^4
};

/// One body on `[start, start + duration]`: **the seam** between rooms. Integrators produce it,
/// ccd consumes it, and what is proven is proven for the Motion.
///
/// Local time s runs from 0 to `duration` (s). `position` starts at the state bit for bit
/// (`position[0]`) and its end is where the next motion starts. `velocity` has a polynomial of its
/// own: for most integrators it is the derivative of `position`, but the thesis' Euler moves on a
/// straight line while its velocity changes, and a dense output may declare an order for velocity
/// that differentiation would lose. `error_radius` bounds the distance between the body's true
/// motion (of any of its points) and the one described here; detectors add it.
struct Motion {
  Instant start;           ///< absolute time of s = 0
  double duration = 0.0;   ///< s; may be infinite for a closed form
  Polynomial<3> position;  ///< p_WB(s), m
  Polynomial<3> velocity;  ///< v(s), m/s
  RotationKind rotation = RotationKind::fixed;
  /// q_WB as (w, x, y, z); degree 0 unless `rotation` is `polynomial`.
  Polynomial<4> quaternion{Vector4(1.0, 0.0, 0.0, 0.0)};
  Vector3 rotation_rate = Vector3::Zero();  ///< of `constant_rate`, world frame, rad/s
  /// Angular velocity, world frame, rad/s; of its own, as `velocity` is.
  Polynomial<3> angular_velocity;
  double error_radius = 0.0;  ///< m

  /// A body that stays where it is, from `start` for ever.
  static Motion at_rest(Instant start, const Pose& pose);
  /// p_0 + v_0 s + a s^2/2, turning at the constant rate of the twist (world frame).
  static Motion ballistic(Instant start, double duration, const Pose& pose, const Twist& twist,
                          const Vector3& acceleration);

  /// Absolute time of s = `duration`.
  [[nodiscard]] Instant end() const { return start + duration; }
  /// At local time s (s), 0 <= s <= `duration`.
  [[nodiscard]] Pose pose(double s) const;
  /// q_WB at local time s (s), unit.
  [[nodiscard]] Quaternion orientation(double s) const;
  /// At local time s (s), world frame.
  [[nodiscard]] Twist twist(double s) const;
  /// Acceleration of the origin: the derivative of `velocity`, m/s^2.
  [[nodiscard]] Vector3 acceleration(double s) const { return velocity.derivative(s); }

  /// The same motion seen from local time s0 on: starts at s0, lasts `duration - s0`.
  [[nodiscard]] Motion shifted(double s0) const;

  /// Upper bound of |p'(s)| on [s0, s1], m/s; rounding included.
  [[nodiscard]] double speed_bound(double s0, double s1) const;
  /// Upper bound of |p(s) - p(s0)| on [s0, s1], m; rounding included.
  [[nodiscard]] double displacement_bound(double s0, double s1) const;
  /// Upper bound of the angular speed on [s0, s1], rad/s: for a polynomial quaternion
  /// 2 |Q'|/|Q|, with |Q| bounded below and |Q'| above by Bernstein coefficients.
  /// Infinite when |Q| cannot be bounded away from zero.
  [[nodiscard]] double angular_speed_bound(double s0, double s1) const;
};

/// Coefficients of p on [s0, s1] in the Bernstein basis, written to `out[0..degree]`: the curve
/// lies in their convex hull [Farouki2012].
template <int Dim>
void bernstein(const Polynomial<Dim>& p, double s0, double s1,
               std::array<typename Polynomial<Dim>::Value, Polynomial<Dim>::max_degree + 1>& out);

/// Compiled once, in core/motion.cpp.
extern template void bernstein<3>(const Polynomial<3>&, double, double,
                                  std::array<Polynomial<3>::Value, Polynomial<3>::max_degree + 1>&);
/// Compiled once, in core/motion.cpp.
extern template void bernstein<4>(const Polynomial<4>&, double, double,
                                  std::array<Polynomial<4>::Value, Polynomial<4>::max_degree + 1>&);

}  // namespace core
}  // namespace kairos
