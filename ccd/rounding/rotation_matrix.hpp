#pragma once

#include "core/pose.hpp"

namespace kairos::ccd {

/// The rotation of a quaternion, columns the body axes in the world. Its length is divided out, so
/// that one that is unit only to some roundings still gives a rotation: entries are off by at most
/// 8 u.
[[nodiscard]] inline Matrix3 rotation_matrix(const Quaternion& q) {
  const double s = 2.0 / q.squaredNorm();
  const double x = s * q.x();
  const double y = s * q.y();
  const double z = s * q.z();
  const double wx = x * q.w();
  const double wy = y * q.w();
  const double wz = z * q.w();
  const double xx = x * q.x();
  const double xy = x * q.y();
  const double xz = x * q.z();
  const double yy = y * q.y();
  const double yz = y * q.z();
  const double zz = z * q.z();
  Matrix3 R;
  R << 1.0 - (yy + zz), xy - wz, xz + wy,  //
      xy + wz, 1.0 - (xx + zz), yz - wx,   //
      xz - wy, yz + wx, 1.0 - (xx + yy);
  return R;
}

}  // namespace kairos::ccd
