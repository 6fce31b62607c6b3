#pragma once

#include "core/motion.hpp"
#include "core/state.hpp"
#include "integrators/hermite.hpp"

namespace kairos::integrators {

/// Pieces of a `Motion` that several steppers share. They write in place: a `Motion` is large and
/// only the coefficients in use should be touched.

/// An orientation that stays (the body is not integrated in rotation).
inline void fixed_rotation(Motion& motion, const Quaternion& q) {
  motion.rotation = RotationKind::fixed;
  motion.quaternion.resize(0);
  motion.quaternion[0] = {q.w(), q.x(), q.y(), q.z()};
  motion.rotation_rate.setZero();
  motion.angular_velocity.resize(0);
  motion.angular_velocity[0].setZero();
}

/// q(s) = exp(w s / 2) q.
inline void constant_rate_rotation(Motion& motion, const Quaternion& q, const Vector3& w) {
  fixed_rotation(motion, q);
  motion.rotation = RotationKind::constant_rate;
  motion.rotation_rate = w;
  motion.angular_velocity[0] = w;
}

/// p0 + c1 s, and v0 + a s of its own.
inline void straight_line(Motion& motion, const Vector3& p0, const Vector3& c1, const Vector3& v0,
                          const Vector3& a) {
  motion.position.resize(1);
  motion.position[0] = p0;
  motion.position[1] = c1;
  motion.velocity.resize(1);
  motion.velocity[0] = v0;
  motion.velocity[1] = a;
}

/// p0 + v0 s + a s^2/2.
inline void parabola(Motion& motion, const Vector3& p0, const Vector3& v0, const Vector3& a) {
  motion.position.resize(2);
  motion.position[0] = p0;
  motion.position[1] = v0;
  motion.position[2] = 0.5 * a;
  motion.velocity.resize(1);
  motion.velocity[0] = v0;
  motion.velocity[1] = a;
}

/// Derivative of a quaternion (w, x, y, z) at angular velocity w, world frame: q' = w q / 2.
[[nodiscard]] inline Vector4 quaternion_rate(const Vector3& w, const Vector4& q) {
  const Vector3 vector = q.tail<3>();
  Vector4 rate;
  rate[0] = -0.5 * w.dot(vector);
  rate.tail<3>() = 0.5 * (q[0] * w + w.cross(vector));
  return rate;
}

[[nodiscard]] inline Vector4 as_vector(const Quaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

/// The orientation between two states h apart as a cubic [hermite]; order 4 where its data are
/// exact. Leaves the angular velocity to the caller.
void cubic_rotation(Motion& motion, double h, const BodyState& before, const BodyState& after);

}  // namespace kairos::integrators
