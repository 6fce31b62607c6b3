#include "ccd/common_point.hpp"

#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr double step_rounding = 64.0 * unit_roundoff;
/// If a direction is this close to a face, by its sine, the whole face counts as deepest.
constexpr double along_face = 1e-3;
/// Of the fifteen axes, the first that is a cross product of edges.
constexpr int first_edges = 6;

/// A box or a ball at one instant, with what is needed of it here.
struct Body {
  Vector3 half;
  Matrix3 axes;
  Vector3 w;
  double w_bound = 0.0;      ///< of |w| over the horizon, rad/s
  double alpha_bound = 0.0;  ///< of its rate, rad/s^2
  double radius = 0.0;       ///< of the ball around the box, m
};

/// The guest's origin from the host's, and how it moves.
struct Way {
  Vector3 d;
  Vector3 v;
  double bent = 0.0;  ///< bound of |d''| over the horizon, m/s^2
};

/// A point of the guest, from its origin, and how it moves along the guest.
struct Place {
  Vector3 arm;
  Vector3 slip = Vector3::Zero();
};

/// How long a place of the guest stays inside the host. In the host's frame its height above a face
/// is bounded by a quadratic: its rate is exact, and its second derivative at most that of the
/// origin's way, of the turning of both, and of Coriolis.
double time_inside(const Body& host, const Body& guest, const Way& way, const Place& place,
                   double reach, const Kinematics& k, double horizon) {
  const Vector3 y = way.d + place.arm;
  const Vector3 rate = way.v + guest.w.cross(place.arm) + place.slip - host.w.cross(y);
  const double slip = place.slip.norm();
  const double lever = place.arm.norm() + slip * horizon;
  const double distance = host.radius + reach;  // while it is inside
  const double speed = way.v.norm() + way.bent * horizon + guest.w_bound * lever + slip;
  const double second = way.bent + (guest.alpha_bound + guest.w_bound * guest.w_bound) * lever +
                        2.0 * guest.w_bound * slip +
                        (host.alpha_bound + host.w_bound * host.w_bound) * distance +
                        2.0 * host.w_bound * (speed + host.w_bound * distance);
  const Vector3 at = host.axes.transpose() * y;
  const Vector3 moves = host.axes.transpose() * rate;
  // It may be outside of one face by the roundoff of the bodies.
  int rounded = 0;
  (host.half - at.cwiseAbs()).minCoeff(&rounded);
  double inside = horizon;
  for (int i = 0; i < 3; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      const bool beyond = i == rounded && sign * at[i] > 0.0;
      const double height = host.half[i] - sign * at[i] + (beyond ? reach : 0.0) - 4.0 * k.error;
      if (!(height > 0.0)) {
        return 0.0;
      }
      inside = std::min(inside,
                        first_root(height, -sign * moves[i] - 2.0 * k.rate_error, -0.5 * second));
    }
  }
  return inside * (1.0 - step_rounding);
}

/// The deepest points of the guest along `into`: its vertex, and where a face or an edge lies
/// across, the place of that face or edge nearest to the host's centre.
double longest_inside(const Body& host, const Body& guest, const Way& way, const Vector3& into,
                      double reach, const Kinematics& k, double horizon) {
  const Vector3 along = guest.axes.transpose() * into;
  const Vector3 centre = guest.axes.transpose() * -way.d;
  Vector3 vertex;
  Vector3 middle;
  for (int i = 0; i < 3; ++i) {
    vertex[i] = std::copysign(guest.half[i], along[i]);
    middle[i] = std::abs(along[i]) < along_face
                    ? std::clamp(centre[i], -guest.half[i], guest.half[i])
                    : vertex[i];
  }
  const double of_middle = time_inside(host, guest, way, {guest.axes * middle}, reach, k, horizon);
  if (middle == vertex || of_middle >= horizon) {
    return of_middle;
  }
  return std::max(of_middle,
                  time_inside(host, guest, way, {guest.axes * vertex}, reach, k, horizon));
}

/// Two edges that cross: the middle of what the host holds of the guest's edge. Both ends of that
/// part move, one along the guest's edge on each of two faces, and the place moves at the mean of
/// their rates: it is the last to come out, however fast the one edge slides on the other.
double middle_inside(const Body& host, const Body& guest, const Way& way, const Vector3& into,
                     int guest_edge, double reach, const Kinematics& k, double horizon) {
  const Vector3 edge = guest.axes.col(guest_edge);
  Vector3 arm = Vector3::Zero();
  for (int i = 0; i < 3; ++i) {
    if (i != guest_edge) {
      arm += std::copysign(guest.half[i], into.dot(guest.axes.col(i))) * guest.axes.col(i);
    }
  }
  // In the host's frame a place at s along the edge is at + s along, and moves at rate + s turning.
  const Vector3 at = host.axes.transpose() * (way.d + arm);
  const Vector3 along = host.axes.transpose() * edge;
  const Vector3 rate =
      host.axes.transpose() * (way.v + guest.w.cross(arm) - host.w.cross(way.d + arm));
  const Vector3 turning = host.axes.transpose() * (guest.w - host.w).cross(edge);
  int rounded = 0;
  (host.axes.transpose() * into).cwiseAbs().maxCoeff(&rounded);
  struct End {
    double s = 0.0;
    double rate = 0.0;
  };
  End low{-guest.half[guest_edge]};
  End high{guest.half[guest_edge]};
  for (int i = 0; i < 3; ++i) {
    if (along[i] == 0.0) {
      continue;
    }
    const double half = host.half[i] + (i == rounded ? reach : 0.0);
    const auto crossing = [&](double face) {
      const double s = (face - at[i]) / along[i];
      return End{s, -(rate[i] + s * turning[i]) / along[i]};
    };
    const End first = crossing(std::copysign(half, -along[i]));
    const End last = crossing(std::copysign(half, along[i]));
    low = first.s > low.s ? first : low;
    high = last.s < high.s ? last : high;
  }
  if (!(low.s < high.s)) {
    return 0.0;
  }
  const double s = low.s + 0.5 * (high.s - low.s);
  const double slip = 0.5 * (low.rate + high.rate);
  const double ahead = guest.half[guest_edge] - (slip < 0.0 ? -s : s);
  const double end = slip != 0.0 ? ahead / std::abs(slip) : horizon;
  return time_inside(host, guest, way, {arm + s * edge, slip * edge}, reach, k,
                     std::min(horizon, end));
}

/// How long the place of the box that is nearest to the ball's centre stays inside the ball: the
/// square of its distance is below a parabola.
double time_in_ball(const Body& box, const Way& way, double radius, const Kinematics& k,
                    double horizon) {
  const Vector3 centre = box.axes.transpose() * -way.d;
  const Vector3 arm = box.axes * centre.cwiseMax(-box.half).cwiseMin(box.half).eval();
  const Vector3 y = way.d + arm;
  const Vector3 rate = way.v + box.w.cross(arm);
  const double lever = arm.norm();
  const double speed = way.v.norm() + way.bent * horizon + box.w_bound * lever + k.rate_error;
  const double second =
      way.bent + (box.alpha_bound + box.w_bound * box.w_bound) * lever + k.second_error;
  const double distance = y.norm() + 4.0 * k.error;
  const double room = (radius - distance) * (radius + distance);
  if (!(room > 0.0)) {
    return 0.0;
  }
  const double slope = -2.0 * (y.dot(rate) + distance * k.rate_error);
  const double inside = first_root(room, slope, -(speed * speed + radius * second));
  return std::min(horizon, inside) * (1.0 - step_rounding);
}

}  // namespace

double common_point(PairKind kind, const PairMotion& motion, const Kinematics& k,
                    const TurnBounds& turn, const Witness& witness, double horizon) {
  if (kind != PairKind::box_box && kind != PairKind::sphere_box) {
    return 0.0;
  }
  const double bent = 2.0 * (k.c.norm() + turn.bend);
  const Body b{motion.half_b(), k.R_WB, k.w_b, turn.w_b, turn.alpha_b, motion.radius_b()};
  const Way of_a{-k.d, -k.v, bent};
  if (kind == PairKind::sphere_box) {  // a point of the ball that does not turn with it
    const Body ball{Vector3::Zero(), Matrix3::Identity(), Vector3::Zero(), 0.0, 0.0, 0.0};
    const double reach = motion.reach();
    return std::max(time_inside(b, ball, of_a, {reach * witness.n}, 0.0, k, horizon),
                    time_in_ball(b, {k.d, k.v, bent}, reach, k, horizon));
  }
  const Body a{motion.half_a(), k.R_WA, k.w_a, turn.w_a, turn.alpha_a, motion.radius_a()};
  const Way of_b{k.d, k.v, bent};
  const double reach = motion.reach();
  if (witness.axis >= first_edges) {
    const int edge_a = witness.edge_a();
    const int edge_b = witness.edge_b();
    return std::max(middle_inside(a, b, of_b, -witness.n, edge_b, reach, k, horizon),
                    middle_inside(b, a, of_a, witness.n, edge_a, reach, k, horizon));
  }
  return std::max(longest_inside(a, b, of_b, -witness.n, reach, k, horizon),
                  longest_inside(b, a, of_a, witness.n, reach, k, horizon));
}

}  // namespace kairos::ccd
