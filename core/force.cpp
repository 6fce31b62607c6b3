#include "core/force.hpp"

#include "core/archive.hpp"

#include <cassert>

namespace kairos {
inline namespace core {

void Island::wrenches(Instant t, std::span<const BodyState> states, std::span<Wrench> out) const {
  assert(states.size() == bodies.size() && out.size() == bodies.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].force = constant_force[i];
    out[i].torque.setZero();
  }
  for (const Force* force : forces) {
    force->add(t, states, out);
  }
}

Vector3 BodyInertia::inverse(const Quaternion& q_WB, const Vector3& x) const {
  const Quaternion q = principal_axes(q_WB);
  return q * Vector3((q.conjugate() * x).cwiseQuotient(principal));
}

Matrix3 BodyInertia::inverse(const Quaternion& q_WB) const {
  const Matrix3 R = principal_axes(q_WB).toRotationMatrix();
  return R * principal.cwiseInverse().asDiagonal() * R.transpose();
}

Vector3 angular_acceleration(const BodyInertia& inertia, const BodyState& state,
                             const Vector3& torque) {
  const Vector3& moments = inertia.principal;
  assert((moments.array() > 0.0).all());
  if (moments.x() == moments.y() && moments.y() == moments.z()) {
    return torque / moments.x();
  }
  // Euler's equations in principal axes. Differences of moments before products: the gyroscopic
  // term of equal moments is then zero and not roundoff.
  const Quaternion axes = inertia.principal_axes(state.pose.orientation);
  const Quaternion to_body = axes.conjugate();
  const Vector3 w = to_body * state.twist.angular;
  const Vector3 torque_B = to_body * torque;
  const Vector3 acceleration_B(
      (torque_B.x() - (moments.z() - moments.y()) * w.y() * w.z()) / moments.x(),
      (torque_B.y() - (moments.x() - moments.z()) * w.z() * w.x()) / moments.y(),
      (torque_B.z() - (moments.y() - moments.x()) * w.x() * w.y()) / moments.z());
  return axes * acceleration_B;
}

void Wrench::persist(Archive& archive) { archive(force, torque); }

}  // namespace core
}  // namespace kairos
