// `EventContacts` when faces or edges land flat, with friction.
#include "core/contacts/centre_of_pressure.hpp"
#include "core/schemes/event/event_contacts.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// How often where a patch is pressed is put where the impulse that follows from that asks for.
constexpr int most_presses = 32;

/// Points of a patch land flat whose rates are the same to this part. An impact that is handed on
/// leaves less and less to come down, and the roundoff of what it was: one end of an edge would be
/// struck alone, and the difference of its ends grow a thousandfold.
constexpr double same_rate = 1e-3;

/// Whether an impulse p goes through the middles of both, to roundoff: then it turns neither.
bool is_along(const Vector3& p, const Pose& a, const Pose& b) {
  const Vector3 between = b.position - a.position;
  const double roundoff =
      64.0 * epsilon * (a.position.lpNorm<Eigen::Infinity>() + between.lpNorm<1>());
  return p.cross(between).norm() <= roundoff * p.norm();
}

/// The point of a patch that is nearest to x, which is outside of it: on a line between two of its
/// points.
Vector3 nearest_point(const ContactManifold& manifold, const Vector3& x) {
  Vector3 nearest = manifold.points[0].position;
  for (std::size_t i = 0; i < manifold.size; ++i) {
    const Vector3& p = manifold.points[i].position;
    for (std::size_t k = 0; k < i; ++k) {
      const Vector3 along = manifold.points[k].position - p;
      const double share = std::clamp((x - p).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const Vector3 between = p + share * along;
      nearest = (between - x).squaredNorm() < (nearest - x).squaredNorm() ? between : nearest;
    }
  }
  return nearest;
}

}  // namespace

/// How the law lets the two of an impact leave, with these inertias: the states of a and of b.
std::pair<BodyState, BodyState> EventContacts::would_leave(const Event& event,
                                                           const BodyInertia& inertia_a,
                                                           const BodyInertia& inertia_b) const {
  BodyState a = motions_.now(event.a);
  BodyState b = motions_.now(event.b);
  Vector3 unused = Vector3::Zero();
  run_.law.apply(event.contact, {run_.model.body(event.a), inertia_a, a, unused},
                 {run_.model.body(event.b), inertia_b, b, unused});
  return {a, b};
}

/// Whether faces or edges that land flat, with friction, leave flat. The points of the patch can
/// press so that nothing turns while the centre of pressure is inside the patch. If it would be
/// outside, the point of the patch nearest to it takes the whole impact.
bool EventContacts::strikes_flat(Event& event) {
  const auto [a, b] = std::pair{event.a, event.b};
  const BodyState& at_a = motions_.now(a);
  const BodyState& at_b = motions_.now(b);
  const Vector3 n = event.contact.normal;
  const ContactManifold manifold =
      run_.detector.manifold(run_.model.shape(a), at_a.pose, run_.model.shape(b), at_b.pose,
                             predictor_.touching_gap(a, b));
  const double approach = normal_velocity(event.contact, at_a, at_b);
  if (manifold.size < 2 || approach >= 0.0) {
    return false;
  }
  const auto rate = [&](std::size_t k) {
    return normal_velocity({manifold.points[k].position, n, 0.0}, at_a, at_b);
  };
  if (!(rate(0) < 0.0)) {
    return false;
  }
  for (std::size_t k = 1; k < manifold.size; ++k) {
    if (std::abs(rate(k) - rate(0)) > same_rate * std::abs(approach)) {
      return false;
    }
  }
  if (manifold.size == 2) {
    // Of an edge, the detector's patch is a sliver, whose centroid hangs on the last digits.
    event.contact.point = 0.5 * (manifold.points[0].position + manifold.points[1].position);
  }
  event.contact.restitution = run_.model.restitution(a, b);
  event.contact.friction = run_.model.friction(a, b);
  const auto rotates = [&](BodyIndex i) {
    return run_.model.is_free(i) && run_.model.inertia(i).rotates;
  };
  const BodyInertia inertia_a = run_.flat_inertia(a);
  const BodyInertia inertia_b = run_.flat_inertia(b);
  // What spins slides elsewhere in another direction: friction acts where the patch is pressed.
  const bool spins = !(at_a.twist.angular - at_b.twist.angular).isZero(0.0);
  for (int round = 0; round < most_presses; ++round) {
    const std::pair<BodyState, BodyState> after = would_leave(event, inertia_a, inertia_b);
    const auto push = [](const BodyState& was, const BodyState& is) {
      return Vector3(is.twist.linear - was.twist.linear);
    };
    if (rotates(a) && rotates(b) && !is_along(push(at_b, after.second), at_a.pose, at_b.pose)) {
      press_together(event, manifold);
      return false;
    }
    double moved = 0.0;
    for (const auto& [i, was, is] :
         {std::tuple{a, &at_a, &after.first}, {b, &at_b, &after.second}}) {
      if (!rotates(i)) {
        continue;
      }
      const Vector3 p = push(*was, *is);
      if (p.dot(n) == 0.0) {
        return false;
      }
      const Vector3& x = was->pose.position;
      const Vector3 pressed = x + p * ((event.contact.point - x).dot(n) / p.dot(n));
      if (!carries_at(manifold, pressed)) {
        event.contact.point = nearest_point(manifold, pressed);
        return false;
      }
      if (spins) {
        moved = std::max(moved, (pressed - event.contact.point).norm());
        event.contact.point = pressed;
      }
    }
    if (moved <= 16.0 * epsilon * event.contact.point.norm()) {
      return true;
    }
  }
  return false;
}

/// Two bodies that turn land flat on each other, one beside the middle of the other: no point of
/// the patch leaves both without a torque. They leave flat where both are turned alike: the patch
/// is pressed where the difference of what the impulse does to their spins has no part along it.
/// Momentum and its moment are kept. If that would be outside the patch, the nearest point of it.
void EventContacts::press_together(Event& event, const ContactManifold& manifold) {
  const auto [a, b] = std::pair{event.a, event.b};
  const BodyState& at_a = motions_.now(a);
  const BodyState& at_b = motions_.now(b);
  const BodyInertia& inertia_a = run_.model.inertia(a);
  const BodyInertia& inertia_b = run_.model.inertia(b);
  const Vector3& n = event.contact.normal;
  // An edge is pressed along itself, and leaves flat where its ends are not turned apart.
  const bool edge = manifold.size == 2;
  const Vector3 t1 = edge ? (manifold.points[1].position - manifold.points[0].position).normalized()
                          : n.unitOrthogonal();
  const Vector3 t2 = n.cross(t1);
  const Matrix3 inverse_a = inertia_a.inverse(at_a.pose.orientation);
  const Matrix3 inverse_b = inertia_b.inverse(at_b.pose.orientation);
  for (int round = 0; round < most_presses; ++round) {
    const BodyState after_b = would_leave(event, inertia_a, inertia_b).second;
    const Vector3 p = inertia_b.mass * (after_b.twist.linear - at_b.twist.linear);
    const auto spins = [&](const Vector3& x) {
      const Vector3 difference = inverse_a * (x - at_a.pose.position).cross(p) +
                                 inverse_b * (x - at_b.pose.position).cross(p);
      return Eigen::Vector2d(t1.dot(difference), t2.dot(difference));
    };
    const Vector3 c = event.contact.point;
    const Eigen::Vector2d here = spins(c);
    Eigen::Matrix2d change;
    change.col(0) = spins(c + t1) - here;
    change.col(1) = spins(c + t2) - here;
    Eigen::Vector2d step = Eigen::Vector2d::Zero();
    if (edge) {
      if (change(1, 0) == 0.0) {
        return;
      }
      step[0] = -here[1] / change(1, 0);
    } else {
      const double det = change.determinant();
      if (!(std::abs(det) > epsilon * change.squaredNorm())) {
        return;
      }
      step = {-(change(1, 1) * here[0] - change(0, 1) * here[1]) / det,
              -(change(0, 0) * here[1] - change(1, 0) * here[0]) / det};
    }
    const Vector3 pressed = c + step[0] * t1 + step[1] * t2;
    if (!carries_at(manifold, pressed)) {
      event.contact.point = nearest_point(manifold, pressed);
      return;
    }
    event.contact.point = pressed;
    if (step.norm() <= 16.0 * epsilon * c.norm()) {
      return;
    }
  }
}

}  // namespace core
}  // namespace kairos
