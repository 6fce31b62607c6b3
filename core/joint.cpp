#include "core/joint.hpp"

#include <cassert>

namespace kairos {
inline namespace core {
namespace {

/// One side of a joint in the world: its arm, its axes, and what its turning does to them.
struct Side {
  Side(const JointSide& side, const JointEnd& end)
      : w(end.twist.angular),
        arm(end.pose.orientation * side.point),
        point(end.pose.position + arm),
        velocity(end.twist.linear + w.cross(arm)),
        axes((end.pose.orientation * side.frame).toRotationMatrix()),
        driven(end.acceleration) {}

  /// Acceleration of the point if the body itself had none but what drives it.
  [[nodiscard]] Vector3 bias() const {
    return w.cross(w.cross(arm)) + driven.linear + driven.angular.cross(arm);
  }

  Vector3 w;
  Vector3 arm;
  Vector3 point;
  Vector3 velocity;
  Matrix3 axes;
  Twist driven;
};

/// The points do not part along a direction of the world.
JointRow point_row(const Side& a, const Side& b, const Vector3& e) {
  return {e, a.arm.cross(e), b.arm.cross(e), e.dot(b.point - a.point), e.dot(b.bias() - a.bias())};
}

/// Along an axis n of a, b's point is no distance away from a's.
JointRow guide_row(const Side& a, const Side& b, const Vector3& n) {
  const Vector3 d = b.point - a.point;
  const Vector3 n_rate = a.w.cross(n);
  const double bias = n.dot(b.bias() - a.bias()) + 2.0 * n_rate.dot(b.velocity - a.velocity) +
                      (a.w.cross(n_rate) + a.driven.angular.cross(n)).dot(d);
  return {n, (a.arm + d).cross(n), b.arm.cross(n), n.dot(d), bias};
}

/// An axis x of a stays normal to an axis y of b.
JointRow axis_row(const Side& a, const Side& b, const Vector3& x, const Vector3& y) {
  const Vector3 turn = y.cross(x);
  const Vector3 turn_rate = b.w.cross(y).cross(x) + y.cross(a.w.cross(x));
  const double bias = turn_rate.dot(b.w - a.w) + turn.dot(b.driven.angular - a.driven.angular);
  return {Vector3::Zero(), turn, turn, x.dot(y), bias, true};
}

/// The distance of the points stays L: r = (d.d - L^2) / 2 L.
JointRow rod_row(const Side& a, const Side& b, double length) {
  const Vector3 d = b.point - a.point;
  const Vector3 e = d / length;
  const Vector3 rate = b.velocity - a.velocity;
  return {e, a.arm.cross(e), b.arm.cross(e), 0.5 * (d.dot(e) - length),
          rate.squaredNorm() / length + e.dot(b.bias() - a.bias())};
}

}  // namespace

std::size_t row_count(JointKind kind) {
  switch (kind) {
    case JointKind::ball:
      return 3;
    case JointKind::hinge:
    case JointKind::slider:
      return 5;
    case JointKind::rod:
      return 1;
    case JointKind::weld:
      break;
  }
  return 6;
}

bool turns(const Joint& joint, const JointSide& side) {
  const bool by_points = joint.kind == JointKind::ball || joint.kind == JointKind::rod;
  return !by_points || !side.point.isZero(0.0);
}

void joint_rows(const Joint& joint, const JointEnd& end_a, const JointEnd& end_b,
                std::span<JointRow> out) {
  assert(out.size() == row_count(joint.kind));
  const Side a(joint.a, end_a);
  const Side b(joint.b, end_b);
  const auto points = [&] {
    for (int k = 0; k < 3; ++k) {
      out[static_cast<std::size_t>(k)] = point_row(a, b, Vector3::Unit(k));
    }
  };
  const auto lock = [&](std::size_t first) {
    for (int k = 0; k < 3; ++k) {
      out[first + static_cast<std::size_t>(k)] =
          axis_row(a, b, a.axes.col(k), b.axes.col((k + 1) % 3));
    }
  };
  switch (joint.kind) {
    case JointKind::ball:
      return points();
    case JointKind::hinge:
      points();
      out[3] = axis_row(a, b, a.axes.col(0), b.axes.col(1));
      out[4] = axis_row(a, b, a.axes.col(0), b.axes.col(2));
      return;
    case JointKind::slider:
      out[0] = guide_row(a, b, a.axes.col(1));
      out[1] = guide_row(a, b, a.axes.col(2));
      return lock(2);
    case JointKind::rod:
      out[0] = rod_row(a, b, joint.length);
      return;
    case JointKind::weld:
      points();
      return lock(3);
  }
}

}  // namespace core
}  // namespace kairos
