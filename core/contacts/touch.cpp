// Where and how fast two features touch; `touch_features.cpp` finds which ones do.
#include "core/contacts/touch.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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
        near(state.pose.to_world(feature.near)),
        sine(feature.sine),
        kind(feature.kind),
        origin(state.pose.position),
        v(state.twist.linear),
        w(state.twist.angular) {}
  /// Of a piece of the body that is there.
  Placed(const TouchFeature& feature, const Pose& piece, const BodyState& state)
      : Placed({feature.kind, piece.to_world(feature.at), piece.orientation * feature.direction,
                feature.radius, piece.to_world(feature.near), feature.sine},
               state) {}

  [[nodiscard]] bool is_rim() const { return kind == Kind::rim; }
  [[nodiscard]] Vector3 velocity(const Vector3& x) const { return v + w.cross(x - origin); }
  /// Acceleration of the material point at x without the body's own accelerations.
  [[nodiscard]] Vector3 centripetal(const Vector3& x) const { return w.cross(w.cross(x - origin)); }

  Vector3 at;
  Vector3 direction;
  double radius;
  Vector3 near;
  double sine;
  Kind kind;
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

/// A point that goes along a line, the axis of a round side, or a rim.
struct OnCurve {
  explicit OnCurve(const Placed& of) : placed(of) { go_near(of.near); }

  void go_near(const Vector3& x) {
    const Vector3& e = placed.direction;
    const Vector3 from = x - placed.at;
    if (placed.is_rim()) {
      turn_to(from - e * e.dot(from));
    } else {
      at = placed.at + e * e.dot(from);
      tangent = e;
    }
  }
  void advance(double s) {
    if (placed.is_rim()) {
      turn_to(at - placed.at + std::clamp(s, -placed.radius, placed.radius) * tangent);
    } else {
      at += s * tangent;
    }
  }

  const Placed& placed;
  Vector3 at;
  Vector3 tangent;
  Vector3 curvature = Vector3::Zero();  ///< derivative of the tangent along the curve, 1/m

 private:
  void turn_to(const Vector3& out) {
    const Vector3 q = out.normalized();
    at = placed.at + placed.radius * q;
    tangent = placed.direction.cross(q);
    curvature = -q / placed.radius;
  }
};

/// Where two lines or rims are nearest to each other, or cross: d from a to b is across both.
struct Nearest {
  Nearest(const Placed& a, const Placed& b) : on_a(a), on_b(b) {
    constexpr int most_rounds = 32;
    constexpr double settled = 1e-15;
    if (!a.is_rim()) {
      on_a.go_near(on_b.at);
    } else if (!b.is_rim()) {
      on_b.go_near(on_a.at);
    }
    double last = std::numeric_limits<double>::infinity();
    for (int round = 0; round < most_rounds; ++round) {
      look();
      const auto [s, u] = along({on_a.tangent.dot(d), on_b.tangent.dot(d)});
      on_a.advance(s);
      on_b.advance(u);
      const double moved = std::max(std::abs(s), std::abs(u));
      if (moved <= settled * (a.radius + b.radius) || (round > 2 && moved >= last)) {
        break;  // nearer than this roundoff does not let it
      }
      last = moved;
    }
    look();
  }

  /// How both points go along their curves where d would leave what is across these by so much.
  [[nodiscard]] std::array<double, 2> along(const std::array<double, 2>& rate) const {
    const double c = on_a.tangent.dot(on_b.tangent);
    const double of_a = 1.0 - d.dot(on_a.curvature);
    const double of_b = 1.0 + d.dot(on_b.curvature);
    const double det = of_a * of_b - c * c;
    return {(of_b * rate[0] - c * rate[1]) / det, (c * rate[0] - of_a * rate[1]) / det};
  }
  void look() { d = on_b.at - on_a.at; }

  OnCurve on_a;
  OnCurve on_b;
  Vector3 d = Vector3::Zero();
};

/// A rim and a line, what is round one, or another rim. Edges have a common normal where they
/// cross; what is round a line has that along which it is nearest.
TouchNow curve_on_curve(const Placed& a, const Placed& b, const Vector3& side) {
  const Nearest nearest(a, b);
  const auto& [on_a, on_b, d] = nearest;
  const double round_a = a.is_rim() ? 0.0 : a.radius;
  const double round_b = b.is_rim() ? 0.0 : b.radius;
  const bool is_round = round_a + round_b > 0.0;
  const Vector3 m = is_round ? d : Vector3(on_a.tangent.cross(on_b.tangent));
  const double length = m.norm();
  const double sign = m.dot(side) < 0.0 ? -1.0 : 1.0;
  const Vector3 n = sign * m / length;
  const Vector3 v = b.velocity(on_b.at) - a.velocity(on_a.at);
  const auto [s, u] = nearest.along({on_a.tangent.dot(v) + d.dot(a.w.cross(on_a.tangent)),
                                     on_b.tangent.dot(v) + d.dot(b.w.cross(on_b.tangent))});
  const Vector3 tangent_a_rate = a.w.cross(on_a.tangent) + s * on_a.curvature;
  const Vector3 tangent_b_rate = b.w.cross(on_b.tangent) + u * on_b.curvature;
  const Vector3 m_rate =
      is_round ? Vector3(v + u * on_b.tangent - s * on_a.tangent)
               : Vector3(tangent_a_rate.cross(on_b.tangent) + on_a.tangent.cross(tangent_b_rate));
  const Vector3 n_rate = sign * (m_rate - n * n.dot(m_rate)) / length;
  const Vector3 change = b.centripetal(on_b.at) + b.w.cross(on_b.tangent) * u -
                         a.centripetal(on_a.at) - a.w.cross(on_a.tangent) * s;
  const Vector3 turns = round_a * a.w + round_b * b.w;
  TouchNow now;
  now.normal = n;
  now.gap = n.dot(d) - round_a - round_b;
  now.point_a = on_a.at + round_a * n;
  now.point_b = on_b.at - round_b * n;
  now.velocity = v - turns.cross(n);
  now.bias = change - turns.cross(n_rate);
  now.normal_bias = n.dot(change) + n_rate.dot(v);
  return now;
}

/// How far a point is from the side of a cone, and how that changes.
struct FromCone {
  FromCone(const Placed& cone, const Vector3& x) {
    const Vector3& e = cone.direction;
    const double cosine = std::sqrt(1.0 - cone.sine * cone.sine);
    const double along = e.dot(x - cone.at);
    const Vector3 out = x - cone.at - along * e;
    const Vector3 q = out.normalized();
    n = cosine * q + cone.sine * e;
    round = e.cross(q);
    bend = cosine / out.norm();
    distance = cosine * out.norm() + cone.sine * along;
  }
  /// Second derivative along these two directions, 1/m.
  [[nodiscard]] double second(const Vector3& x, const Vector3& y) const {
    return bend * round.dot(x) * round.dot(y);
  }

  double distance = 0.0;
  Vector3 n = Vector3::Zero();      ///< its gradient
  Vector3 round = Vector3::Zero();  ///< around the axis: the only direction in which that turns
  double bend = 0.0;                ///< 1/m
};

/// The point of a line or a rim of b that is nearest to the side of a cone of a.
OnCurve nearest_to_cone(const Placed& a, const Placed& b) {
  constexpr int most_rounds = 32;
  constexpr double settled = 1e-15;
  OnCurve on_b(b);
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_rounds; ++round) {
    const FromCone from(a, on_b.at);
    const double slope = from.n.dot(on_b.tangent);
    const double bend = from.second(on_b.tangent, on_b.tangent) + from.n.dot(on_b.curvature);
    const double step = -slope / bend;
    on_b.advance(step);
    const double moved = std::abs(step);
    if (moved <= settled / from.bend || (round > 2 && moved >= last)) {
      break;
    }
    last = moved;
  }
  return on_b;
}

/// A ball, a line or a rim of b, or what is round a line, at the side of a cone of a: along a curve
/// to second order of the distance from the cone, which is least there.
TouchNow on_cone(const Placed& a, const Placed& b) {
  const bool is_ball = b.kind == Kind::ball;
  const double roundness = b.is_rim() ? 0.0 : b.radius;
  Vector3 at = b.at;
  Vector3 tangent = Vector3::Zero();
  Vector3 curvature = Vector3::Zero();
  if (!is_ball) {
    const OnCurve on_b = nearest_to_cone(a, b);
    at = on_b.at;
    tangent = on_b.tangent;
    curvature = on_b.curvature;
  }
  const FromCone from(a, at);
  const Vector3& n = from.n;
  TouchNow now;
  now.normal = n;
  now.gap = from.distance - roundness;
  now.point_b = at - roundness * n;
  now.point_a = at - from.distance * n;
  const Vector3 seen = b.velocity(at) - a.velocity(at);  // in the frame of a
  const double turning = from.second(tangent, seen) + n.dot((b.w - a.w).cross(tangent));
  const double along =
      is_ball ? 0.0 : -turning / (from.second(tangent, tangent) + n.dot(curvature));
  const Vector3 moves = seen + along * tangent;
  const Vector3 n_rate = from.bend * from.round * from.round.dot(moves) + a.w.cross(n);
  now.normal_bias = n.dot(b.centripetal(at) - a.centripetal(at) - 2.0 * a.w.cross(seen)) +
                    from.second(seen, seen) + turning * along;
  now.velocity = b.velocity(now.point_b) - a.velocity(now.point_a);
  const Vector3 x_rate = b.velocity(at) + along * tangent - roundness * n_rate;
  now.bias = b.w.cross(x_rate - b.v) - a.w.cross(x_rate - a.v);
  return now;
}

/// Whether a feature is a line or a rim.
bool is_curve(const TouchFeature& feature) {
  return feature.kind == Kind::line || feature.kind == Kind::rim;
}

/// A feature of a in the world.
Placed placed_a(const Touch& touch, const BodyState& a) {
  return touch.of_pieces ? Placed(touch.on_a, touch.piece_a, a) : Placed(touch.on_a, a);
}
Placed placed_b(const Touch& touch, const BodyState& b) {
  return touch.of_pieces ? Placed(touch.on_b, touch.piece_b, b) : Placed(touch.on_b, b);
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
  const Placed a = placed_a(touch, state_a);
  const Placed b = placed_b(touch, state_b);
  if (touch.on_a.kind == Kind::cone) {
    return on_cone(a, b);
  }
  if (touch.on_b.kind == Kind::cone) {
    return turned_round(on_cone(b, a));
  }
  if (touch.on_a.kind == Kind::line && touch.on_b.kind == Kind::line) {
    return line_on_line(a, b, touch.normal);
  }
  if (is_curve(touch.on_a) && is_curve(touch.on_b)) {
    return curve_on_curve(a, b, touch.normal);
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

TouchNow look_at(const TouchFeature& feature, const Vector3& x) {
  const Touch touch{.on_a = feature, .on_b = {Kind::ball, x, Vector3::Zero(), 0.0}};
  return look_at(touch, BodyState{}, BodyState{});
}

double crossing_sine(const Touch& touch, const BodyState& state_a, const BodyState& state_b) {
  const Placed a = placed_a(touch, state_a);
  const Placed b = placed_b(touch, state_b);
  const bool of_cone = a.kind == Kind::cone || b.kind == Kind::cone;
  if (of_cone && (is_curve(touch.on_a) || is_curve(touch.on_b))) {
    const Placed& cone = a.kind == Kind::cone ? a : b;
    const OnCurve on = nearest_to_cone(cone, a.kind == Kind::cone ? b : a);
    return std::sqrt(1.0 - cone.sine * cone.sine) *
           std::abs(FromCone(cone, on.at).round.dot(on.tangent));
  }
  if (!is_curve(touch.on_a) || !is_curve(touch.on_b)) {
    return 1.0;
  }
  if (!a.is_rim() && !b.is_rim()) {
    return a.direction.cross(b.direction).norm();
  }
  const Nearest nearest(a, b);
  return nearest.on_a.tangent.cross(nearest.on_b.tangent).norm();
}

}  // namespace core
}  // namespace kairos
