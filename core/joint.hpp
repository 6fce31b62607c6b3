#pragma once

#include "core/state.hpp"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kairos {
inline namespace core {

/// What a joint leaves free between its two sides.
enum class JointKind {
  ball,    ///< turning: their points stay together; 3 rows
  hinge,   ///< turning about one axis; 5 rows
  slider,  ///< moving along one axis; 5 rows
  rod,     ///< all but the distance of their points; 1 row
  weld,    ///< nothing; 6 rows
};
inline constexpr std::array<std::string_view, 5> joint_kind_names{"ball", "hinge", "slider", "rod",
                                                                  "weld"};
/// As scene files say it.
[[nodiscard]] constexpr std::string_view to_string(JointKind kind) {
  return joint_kind_names[static_cast<std::size_t>(kind)];
}

/// One of the two things that a joint holds together: a body, or the world.
struct JointSide {
  std::optional<BodyIndex> body;    ///< none: the world
  Vector3 point = Vector3::Zero();  ///< where the joint is, body frame (the world's if none), m
  /// Of the joint, in the same frame: its x axis is the axis of a hinge or slider.
  Quaternion frame = Quaternion::Identity();
};

/// Two bodies, or a body and the world, that cannot move freely against each other. Frictionless.
struct Joint {
  JointKind kind = JointKind::ball;
  JointSide a;
  JointSide b;
  double length = 0.0;   ///< of a rod, m, > 0
  bool collide = false;  ///< whether the two also meet as solids
  std::string name;      ///< for messages; may be empty
  int line = 0;          ///< where it was written
};

/// A side of a joint at an instant, with what is known of its acceleration beforehand.
struct JointEnd {
  Pose pose;
  Twist twist;
  Twist acceleration;  ///< of what is driven; 0 otherwise
};

/// One scalar constraint r = 0 on the motion of a against b:
///
///   r'  = direction . (v_b - v_a) + turn_b . w_b - turn_a . w_a
///   r'' = the same of the accelerations + bias
struct JointRow {
  Vector3 direction = Vector3::Zero();  ///< world frame
  Vector3 turn_a = Vector3::Zero();
  Vector3 turn_b = Vector3::Zero();
  double residual = 0.0;  ///< r, m; of rows that only turn: 1 (an angle)
  double bias = 0.0;      ///< m/s^2 or 1/s^2
  bool turns_only = false;

  /// r' for these velocities of the two sides, m/s or 1/s.
  [[nodiscard]] double rate(const Twist& a, const Twist& b) const {
    return direction.dot(b.linear - a.linear) + turn_b.dot(b.angular) - turn_a.dot(a.angular);
  }
};

inline constexpr std::size_t most_joint_rows = 6;
/// How many rows a joint of this kind has.
[[nodiscard]] std::size_t row_count(JointKind kind);
/// Whether it does anything to the orientation of that side's body.
[[nodiscard]] bool turns(const Joint& joint, const JointSide& side);
/// The rows of a joint whose sides are there; as many as `row_count`.
void joint_rows(const Joint& joint, const JointEnd& a, const JointEnd& b, std::span<JointRow> out);

}  // namespace core
}  // namespace kairos
