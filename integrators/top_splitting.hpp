#pragma once

#include "core/pose.hpp"

namespace kairos::integrators {

/// Turns a free top by h: the symmetric product of rotations about its principal axes
/// [McLachlan1993]. The angular momentum `L_W` (world frame, kg m^2/s) is constant; only the
/// orientation moves.
[[nodiscard]] Quaternion split_top(const Vector3& principal, const Vector3& L_W, double h,
                                   const Quaternion& q_WB);

/// Angular momentum in the world frame, kg m^2/s.
[[nodiscard]] inline Vector3 angular_momentum(const Vector3& principal, const Quaternion& q_WB,
                                              const Vector3& w) {
  return q_WB * Vector3(principal.cwiseProduct(q_WB.conjugate() * w));
}
/// Angular velocity in the world frame, rad/s.
[[nodiscard]] inline Vector3 angular_velocity(const Vector3& principal, const Quaternion& q_WB,
                                              const Vector3& L_W) {
  return q_WB * Vector3((q_WB.conjugate() * L_W).cwiseQuotient(principal));
}

}  // namespace kairos::integrators
