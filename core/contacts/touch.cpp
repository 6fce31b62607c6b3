// Where and how fast two features touch; `touch_features.cpp` finds which ones do.
#include "core/contacts/touch.hpp"

#include <Eigen/Geometry>

#include <utility>

namespace kairos {
inline namespace core {
namespace {

using Kind = TouchFeature::Kind;

/// A feature in the world, and how it moves.
struct Placed {
  Placed(const TouchFeature& feature, const BodyState& state)
      : at(state.pose.to_world(feature.at)),
        direction(state.pose.orientation * feature.direction),
        radius(feature.radius),
        origin(state.pose.position),
        v(state.twist.linear),
        w(state.twist.angular) {}
  /// Of a piece of the body that is there.
  Placed(const TouchFeature& feature, const Pose& piece, const BodyState& state)
      : Placed({feature.kind, piece.to_world(feature.at), piece.orientation * feature.direction,
                feature.radius},
               state) {}

  [[nodiscard]] Vector3 velocity(const Vector3& x) const { return v + w.cross(x - origin); }
  /// Acceleration of the material point at x without the body's own accelerations.
  [[nodiscard]] Vector3 centripetal(const Vector3& x) const { return w.cross(w.cross(x - origin)); }

  Vector3 at;
  Vector3 direction;
  double radius;
  Vector3 origin;
  Vector3 v;
  Vector3 w;
};

/// Where surfaces touch: the points, and the velocities of normal and point of contact.
TouchNow of_points(const Placed& a, const Placed& b, const Vector3& n, double gap) {
  TouchNow now;
  now.normal = n;
  now.gap = gap;
  now.point_a = a.at + a.radius * n;
  now.point_b = b.at - b.radius * n;
  return now;
}

/// A ball of b over a plane of a.
TouchNow ball_on_plane(const Placed& a, const Placed& b) {
  const Vector3& n = a.direction;
  const double gap = n.dot(b.at - a.at) - b.radius;
  TouchNow now = of_points(a, b, n, gap);
  now.point_a = b.at - (b.radius + gap) * n;
  const Vector3 n_rate = a.w.cross(n);
  const Vector3 centre = b.velocity(b.at);
  const Vector3 slip = centre - a.velocity(b.at);
  now.normal_bias = n.dot(b.centripetal(b.at) - a.centripetal(b.at) - 2.0 * a.w.cross(slip));
  now.velocity = b.velocity(now.point_b) - a.velocity(now.point_a);
  const Vector3 x_rate = centre - b.radius * n_rate;
  now.bias = b.centripetal(b.at) - b.radius * b.w.cross(n_rate) - a.w.cross(x_rate - a.v);
  return now;
}

/// A rim of b over a plane of a, tilted from it: its lowest point goes round it as it rolls.
TouchNow rim_on_plane(const Placed& a, const Placed& b) {
  const Vector3& n = a.direction;
  const Vector3& e = b.direction;
  const double s = n.dot(e);
  const Vector3 up = n - s * e;  // of the plane of the rim
  const double k = up.norm();
  const Vector3 u = up / k;
  TouchNow now;
  now.normal = n;
  now.gap = n.dot(b.at - a.at) - b.radius * k;
  now.point_b = b.at - b.radius * u;
  now.point_a = now.point_b - now.gap * n;
  const Vector3 n_rate = a.w.cross(n);
  const Vector3 e_rate = b.w.cross(e);
  const Vector3 w = b.w - a.w;
  const double s_rate = n.dot(w.cross(e));
  const double s_second = n_rate.dot(w.cross(e)) + n.dot(w.cross(e_rate));
  const double k_second =
      -(s_rate * s_rate + s * s_second) / k - s * s * s_rate * s_rate / (k * k * k);
  const Vector3 centre = b.velocity(b.at);
  const Vector3 slip = centre - a.velocity(b.at);
  now.normal_bias = n.dot(b.centripetal(b.at) - a.centripetal(b.at) - 2.0 * a.w.cross(slip)) -
                    b.radius * k_second;
  now.velocity = b.velocity(now.point_b) - a.velocity(now.point_a);
  const Vector3 up_rate = n_rate - s_rate * e - s * e_rate;
  const Vector3 x_rate = centre - b.radius * (up_rate - u * u.dot(up_rate)) / k;
  now.bias = b.w.cross(x_rate - b.v) - a.w.cross(x_rate - a.v);
  return now;
}

TouchNow ball_on_ball(const Placed& a, const Placed& b) {
  const Vector3 between = b.at - a.at;
  const double distance = between.norm();
  const Vector3 n = between / distance;
  TouchNow now = of_points(a, b, n, distance - a.radius - b.radius);
  const Vector3 v = b.velocity(b.at) - a.velocity(a.at);
  const Vector3 across = v - n * n.dot(v);
  const Vector3 n_rate = across / distance;
  const Vector3 centripetal = b.centripetal(b.at) - a.centripetal(a.at);
  now.normal_bias = n.dot(centripetal) + across.squaredNorm() / distance;
  now.velocity = b.velocity(now.point_b) - a.velocity(now.point_a);
  now.bias = centripetal - b.radius * b.w.cross(n_rate) - a.radius * a.w.cross(n_rate);
  return now;
}

/// A ball of b at a line of a, or at what is round it.
TouchNow ball_on_line(const Placed& a, const Placed& b) {
  const Vector3& e = a.direction;
  const Vector3 between = b.at - a.at;
  const Vector3 foot = a.at + e * e.dot(between);
  const double distance = (b.at - foot).norm();
  const Vector3 n = (b.at - foot) / distance;
  TouchNow now = of_points(a, b, n, distance - a.radius - b.radius);
  now.point_a = foot + a.radius * n;
  const Vector3 centre = b.velocity(b.at);
  const Vector3 seen = centre - a.velocity(b.at);  // in the frame of a
  const Vector3 across = seen - n * n.dot(seen) - e * e.dot(seen);
  const Vector3 n_rate = across / distance + a.w.cross(n);
  now.normal_bias = n.dot(b.centripetal(b.at) - a.centripetal(b.at) - 2.0 * a.w.cross(seen)) +
                    across.squaredNorm() / distance;
  now.velocity = b.velocity(now.point_b) - a.velocity(now.point_a);
  const Vector3 x_rate = centre - b.radius * n_rate;
  now.bias = b.centripetal(b.at) - b.radius * b.w.cross(n_rate) - a.w.cross(x_rate - a.v);
  return now;
}

/// A ball of b at a rim of a. The second derivative of the distance from a circle is that from a
/// point in the plane of its axis, and along the circle its slope there over how far out it is.
TouchNow ball_on_rim(const Placed& a, const Placed& b) {
  const Vector3& e = a.direction;
  const Vector3 between = b.at - a.at;
  const double along = e.dot(between);
  const Vector3 from_axis = between - along * e;
  const double out = from_axis.norm();
  const Vector3 q = from_axis / out;
  const double distance = Vector3(along * e + (out - a.radius) * q).norm();
  const Vector3 n = (along * e + (out - a.radius) * q) / distance;
  TouchNow now;
  now.normal = n;
  now.gap = distance - b.radius;
  now.point_a = a.at + a.radius * q;
  now.point_b = b.at - b.radius * n;
  const Vector3 centre = b.velocity(b.at);
  const Vector3 seen = centre - a.velocity(b.at);  // in the frame of a
  const Vector3 t = e.cross(q);
  const Vector3 m = t.cross(n);
  const double across = m.dot(seen) / distance;
  const double round = t.dot(seen) * (out - a.radius) / (distance * out);
  const Vector3 n_rate = across * m + round * t + a.w.cross(n);
  now.normal_bias = n.dot(b.centripetal(b.at) - a.centripetal(b.at) - 2.0 * a.w.cross(seen)) +
                    across * m.dot(seen) + round * t.dot(seen);
  now.velocity = b.velocity(now.point_b) - a.velocity(now.point_a);
  const Vector3 x_rate = centre - b.radius * n_rate;
  now.bias = b.centripetal(b.at) - b.radius * b.w.cross(n_rate) - a.w.cross(x_rate - a.v);
  return now;
}

/// Two lines, or what is round them. Their nearest points, the feet, move along them.
TouchNow line_on_line(const Placed& a, const Placed& b, const Vector3& side) {
  const Vector3 m = a.direction.cross(b.direction);
  const double length = m.norm();
  const double sign = m.dot(side) < 0.0 ? -1.0 : 1.0;
  const Vector3 n = sign * m / length;
  const Vector3 between = b.at - a.at;
  // Nearest points: between + t_b e_b - t_a e_a along n.
  const Vector3 to_a = b.direction.cross(m) / (length * length);
  const Vector3 to_b = a.direction.cross(m) / (length * length);
  const Vector3 foot_a = a.at + a.direction * between.dot(to_a);
  const Vector3 foot_b = b.at + b.direction * between.dot(to_b);
  const double distance = n.dot(between);
  const Vector3 m_rate =
      a.w.cross(a.direction).cross(b.direction) + a.direction.cross(b.w.cross(b.direction));
  const Vector3 n_rate = sign * (m_rate - n * n.dot(m_rate)) / length;
  const Vector3 v = b.velocity(foot_b) - a.velocity(foot_a);
  const Vector3 left = v - distance * n_rate;
  const Vector3 change = b.centripetal(foot_b) + b.w.cross(b.direction) * left.dot(to_b) -
                         a.centripetal(foot_a) - a.w.cross(a.direction) * left.dot(to_a);
  const Vector3 turns = a.radius * a.w + b.radius * b.w;
  TouchNow now;
  now.normal = n;
  now.gap = distance - a.radius - b.radius;
  now.point_a = foot_a + a.radius * n;
  now.point_b = foot_b - b.radius * n;
  now.velocity = v - turns.cross(n);
  now.bias = change - turns.cross(n_rate);
  now.normal_bias = n.dot(change) + n_rate.dot(v);
  return now;
}

/// The same touch seen from b.
TouchNow turned_round(TouchNow now) {
  std::swap(now.point_a, now.point_b);
  now.normal = -now.normal;
  now.velocity = -now.velocity;
  now.bias = -now.bias;
  return now;
}

/// Without belts.
TouchNow look_at_bodies(const Touch& touch, const BodyState& state_a, const BodyState& state_b) {
  const Placed a =
      touch.of_pieces ? Placed(touch.on_a, touch.piece_a, state_a) : Placed(touch.on_a, state_a);
  const Placed b =
      touch.of_pieces ? Placed(touch.on_b, touch.piece_b, state_b) : Placed(touch.on_b, state_b);
  if (touch.on_a.kind == Kind::line && touch.on_b.kind == Kind::line) {
    return line_on_line(a, b, touch.normal);
  }
  if (touch.on_a.kind == Kind::plane) {
    return touch.on_b.kind == Kind::rim ? rim_on_plane(a, b) : ball_on_plane(a, b);
  }
  if (touch.on_b.kind == Kind::plane) {
    return turned_round(touch.on_a.kind == Kind::rim ? rim_on_plane(b, a) : ball_on_plane(b, a));
  }
  if (touch.on_a.kind == Kind::rim) {
    return ball_on_rim(a, b);
  }
  if (touch.on_b.kind == Kind::rim) {
    return turned_round(ball_on_rim(b, a));
  }
  if (touch.on_a.kind == Kind::line) {
    return ball_on_line(a, b);
  }
  return touch.on_b.kind == Kind::line ? turned_round(ball_on_line(b, a)) : ball_on_ball(a, b);
}

}  // namespace

TouchNow look_at(const Touch& touch, const BodyState& state_a, const BodyState& state_b) {
  TouchNow now = look_at_bodies(touch, state_a, state_b);
  if (!touch.belt.isZero(0.0)) {
    now.velocity += touch.belt - now.normal * now.normal.dot(touch.belt);
  }
  return now;
}

}  // namespace core
}  // namespace kairos
