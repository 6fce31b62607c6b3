#include "core/bent_motion.hpp"

#include "core/circular.hpp"

#include <algorithm>

namespace kairos {
inline namespace core {
namespace {

/// Adds the cubic that has these values and slopes at 0 and h.
template <int Dim>
void bend(Polynomial<Dim>& p, double h, const typename Polynomial<Dim>::Value& d0,
          const typename Polynomial<Dim>::Value& r0, const typename Polynomial<Dim>::Value& d1,
          const typename Polynomial<Dim>::Value& r1) {
  if (d0.isZero(0.0) && r0.isZero(0.0) && d1.isZero(0.0) && r1.isZero(0.0)) {
    return;
  }
  p.resize(std::max(p.degree(), 3));
  p[0] += d0;
  p[1] += r0;
  p[2] += (3.0 * (d1 - d0) / h - 2.0 * r0 - r1) / h;
  p[3] += (2.0 * (d0 - d1) / h + r0 + r1) / (h * h);
}

/// Adds the straight line that has these values at 0 and h.
void tilt(Polynomial<3>& p, double h, const Vector3& d0, const Vector3& d1) {
  if (d0.isZero(0.0) && d1.isZero(0.0)) {
    return;
  }
  p.resize(std::max(p.degree(), 1));
  p[0] += d0;
  p[1] += (d1 - d0) / h;
}

Vector4 as_vector(const Quaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

/// From the quaternion of a motion, which may have any length, to an orientation: to that of its
/// two quaternions of this length which is nearer.
Vector4 correction(const Vector4& from, const Quaternion& to) {
  const Vector4 target = as_vector(to);
  const double length = from.norm();
  return (from.dot(target) < 0.0 ? -length : length) * target - from;
}

/// How fast a quaternion of any length changes that turns at this rate, rad/s, world frame.
Vector4 turning(const Vector3& rate, const Vector4& q) {
  const Quaternion half(0.0, 0.5 * rate.x(), 0.5 * rate.y(), 0.5 * rate.z());
  return as_vector(half * Quaternion(q[0], q[1], q[2], q[3]));
}

Vector3 rotation_between(const Quaternion& from, const Quaternion& to) {
  Quaternion turn = to * from.conjugate();
  if (turn.w() < 0.0) {
    turn.coeffs() = -turn.coeffs();
  }
  const double sine = turn.vec().norm();
  return sine > 0.0 ? Vector3(2.0 * arc_tangent(sine, turn.w()) / sine * turn.vec())
                    : Vector3(Vector3::Zero());
}

}  // namespace

void bend_to(Motion& motion, double h, const BodyState& before, const BodyState& after) {
  const Vector3 v0 = before.twist.linear - motion.velocity[0];
  const Vector3 v1 = after.twist.linear - motion.velocity(h);
  bend<3>(motion.position, h, before.pose.position - motion.position[0], v0,
          after.pose.position - motion.position(h), v1);
  motion.position[0] = before.pose.position;
  tilt(motion.velocity, h, v0, v1);
  if (motion.rotation == RotationKind::fixed) {
    return;
  }
  tilt(motion.angular_velocity, h, before.twist.angular - motion.angular_velocity[0],
       after.twist.angular - motion.angular_velocity(h));
  if (motion.rotation == RotationKind::constant_rate) {
    motion.quaternion[0] = as_vector(before.pose.orientation);
    motion.rotation_rate = rotation_between(before.pose.orientation, after.pose.orientation) / h;
    return;
  }
  const Vector4 d0 = correction(motion.quaternion[0], before.pose.orientation);
  const Vector4 d1 = correction(motion.quaternion(h), after.pose.orientation);
  const Vector4 r0 = turning(before.twist.angular, motion.quaternion[0] + d0);
  const Vector4 r1 = turning(after.twist.angular, motion.quaternion(h) + d1);
  bend<4>(motion.quaternion, h, d0, r0 - motion.quaternion.derivative(0.0), d1,
          r1 - motion.quaternion.derivative(h));
}

}  // namespace core
}  // namespace kairos
