#pragma once

#include "core/force.hpp"

namespace kairos::integrators {

/// Turns a free top by h: the symmetric product of rotations about its principal axes
/// [McLachlan1993]. The angular momentum `L_W` (world frame, kg m^2/s) is constant; only the
/// orientation moves.
[[nodiscard]] Quaternion split_top(const BodyInertia& inertia, const Vector3& L_W, double h,
                                   const Quaternion& q_WB);

/// Angular momentum in the world frame, kg m^2/s.
[[nodiscard]] inline Vector3 angular_momentum(const BodyInertia& inertia, const Quaternion& q_WB,
                                              const Vector3& w) {
  const Quaternion q = inertia.principal_axes(q_WB);
  return q * Vector3(inertia.principal.cwiseProduct(q.conjugate() * w));
}
/// Angular velocity in the world frame, rad/s.
[[nodiscard]] inline Vector3 angular_velocity(const BodyInertia& inertia, const Quaternion& q_WB,
                                              const Vector3& L_W) {
  return inertia.inverse(q_WB, L_W);
}

}  // namespace kairos::integrators
