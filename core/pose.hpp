#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace kairos {
/// The room `core` is an inline namespace: its vocabulary is the library's own (`kairos::Pose`),
/// while the other rooms keep theirs (`kairos::ccd`, `kairos::integrators`, `kairos::experiments`).
inline namespace core {

/// A point, a direction or a rate in space.
using Vector3 = Eigen::Vector3d;
/// A rotation or a tensor in space.
using Matrix3 = Eigen::Matrix3d;
/// Unaligned on purpose: the layout of public types must not depend on the consumer's `-march`.
using Vector4 = Eigen::Matrix<double, 4, 1, Eigen::DontAlign>;
/// Unit quaternion `q_WB`, body to world; unaligned as `Vector4`.
using Quaternion = Eigen::Quaternion<double, Eigen::DontAlign>;

/// Where a body is: position of its origin (its centre of mass) and its orientation.
/// Frames: W world, B body. Units: m; unit quaternion.
struct Pose {
  Vector3 position = Vector3::Zero();               ///< p_WB, m
  Quaternion orientation = Quaternion::Identity();  ///< q_WB, unit

  /// A point of the body, told in the world frame, m.
  [[nodiscard]] Vector3 to_world(const Vector3& point_B) const {
    return position + orientation * point_B;
  }
  /// A point of the world, told in the body frame, m.
  [[nodiscard]] Vector3 to_body(const Vector3& point_W) const {
    return orientation.conjugate() * (point_W - position);
  }
};

/// How a body moves: velocity of its origin and angular velocity, both in the world frame.
struct Twist {
  Vector3 linear = Vector3::Zero();   ///< m/s
  Vector3 angular = Vector3::Zero();  ///< rad/s

  /// Velocity of the material point at `point_W` of a body whose origin is at `origin_W`, m/s.
  [[nodiscard]] Vector3 at(const Vector3& point_W, const Vector3& origin_W) const {
    return linear + angular.cross(point_W - origin_W);
  }
};

/// exp(rotation_W / 2) q: the orientation after turning by the rotation vector (rad, world frame).
[[nodiscard]] Quaternion rotate(const Vector3& rotation_W, const Quaternion& q_WB);

}  // namespace core
}  // namespace kairos
