#include "simulation/view/straight_motion.hpp"

#include "core/circular.hpp"

#include <cmath>
#include <numbers>

namespace kairos {
inline namespace simulation {
namespace {

Vector4 coefficients(const Quaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

/// The rotation vector of the short way from one orientation to another, world frame, rad.
Vector3 short_way(const Quaternion& from, const Quaternion& to) {
  Quaternion turn = to * from.conjugate();
  if (turn.w() < 0.0) {
    turn.coeffs() *= -1.0;
  }
  const double sine = turn.vec().norm();
  return sine > 0.0 ? Vector3(turn.vec() * (2.0 * arc_tangent(sine, turn.w()) / sine))
                    : Vector3::Zero();
}

/// The rotation vector from one orientation to the other with as many turns as `guess` has.
Vector3 turn_like(const Vector3& guess, const Quaternion& from, const Quaternion& to) {
  const Vector3 shortest = short_way(from, to);
  const double angle = shortest.norm();
  const double guessed = guess.norm();
  if (!(angle > 1e-12) && !(guessed > 0.0)) {
    return shortest;
  }
  const Vector3 axis = angle > 1e-12 ? Vector3(shortest / angle) : Vector3(guess / guessed);
  const double turns = std::round((axis.dot(guess) - angle) / (2.0 * std::numbers::pi));
  return shortest + 2.0 * std::numbers::pi * turns * axis;
}

void turn(Motion& motion, double h, const BodyState& from, const BodyState& to) {
  motion.quaternion[0] = coefficients(from.pose.orientation);
  motion.angular_velocity =
      Polynomial<3>(from.twist.angular, Vector3((to.twist.angular - from.twist.angular) / h));
  if (from.pose.orientation.coeffs() != to.pose.orientation.coeffs()) {
    const Vector3 guess = 0.5 * h * (from.twist.angular + to.twist.angular);
    motion.rotation = RotationKind::constant_rate;
    motion.rotation_rate = turn_like(guess, from.pose.orientation, to.pose.orientation) / h;
  }
}

}  // namespace

Motion straight_motion(Instant start, double duration, const BodyState& from, const BodyState& to) {
  const double h = duration;
  Motion motion;
  motion.start = start;
  motion.duration = h;
  motion.position =
      Polynomial<3>(from.pose.position, Vector3((to.pose.position - from.pose.position) / h));
  motion.velocity =
      Polynomial<3>(from.twist.linear, Vector3((to.twist.linear - from.twist.linear) / h));
  turn(motion, h, from, to);
  return motion;
}

Motion smooth_motion(Instant start, double duration, const BodyState& from, const BodyState& to) {
  const double h = duration;
  const Vector3 mean = (to.pose.position - from.pose.position) / h;
  const Vector3& v0 = from.twist.linear;
  const Vector3& v1 = to.twist.linear;
  Motion motion = straight_motion(start, duration, from, to);
  motion.position = Polynomial<3>(from.pose.position, v0, Vector3((3.0 * mean - 2.0 * v0 - v1) / h),
                                  Vector3((v0 + v1 - 2.0 * mean) / (h * h)));
  motion.velocity = motion.position.differentiated();
  return motion;
}

}  // namespace simulation
}  // namespace kairos
