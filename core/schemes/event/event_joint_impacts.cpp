// `EventContacts` when one of two bodies that strike hangs on joints: these pass the impact on.
#include "core/joint_system.hpp"
#include "core/schemes/event/event_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

/// Relative accelerations that joints leave free are roundoff below this.
constexpr double at_rest = 1e-9;
/// Hops below this part of the extent are summed up, and the body is at rest from there on. The
/// pressing force changes by as small a part while they last, and so does the sum. Smaller hops
/// would be resolved worse than that: a contact is located within a gap of roundoff.
constexpr double small_hop = 1e-8;

/// The bodies of an island that an impact takes along, and what a unit impulse does to them.
struct StruckIsland {
  const Island* island = nullptr;  ///< null: not free
  std::vector<BodyState> states;
  std::vector<Twist> response;  ///< changes of velocity by a unit impulse
  double driven = 0.0;          ///< work of driven sides of joints in that, J

  StruckIsland() = default;
  StruckIsland(const Model& model, const EventMotions& motions, BodyIndex i) {
    if (model.is_free(i)) {
      island = &model.islands()[model.island_of(i)];
      for (const BodyIndex k : island->bodies) {
        states.push_back(motions.now(k));
      }
      response.resize(states.size());
    }
  }

  [[nodiscard]] std::size_t place(BodyIndex i) const {
    const auto& bodies = island->bodies;
    return static_cast<std::size_t>(std::find(bodies.begin(), bodies.end(), i) - bodies.begin());
  }
  [[nodiscard]] bool holds(BodyIndex i) const {
    return island != nullptr && place(i) < states.size();
  }
  void push(BodyIndex i, const Vector3& point, const Vector3& impulse) {
    const std::size_t k = place(i);
    const BodyInertia& inertia = island->inertia[k];
    const Pose& pose = states[k].pose;
    response[k].linear += impulse / inertia.mass;
    if (inertia.rotates) {
      response[k].angular +=
          inertia.inverse(pose.orientation, (point - pose.position).cross(impulse));
    }
  }
  void pass_on(Instant t) {
    if (island != nullptr && island->joints != nullptr) {
      driven = island->joints->pass_on(t, states, response);
    }
  }
  /// Velocity, or change of velocity, at a point of a body.
  [[nodiscard]] Vector3 at(std::span<const Twist> v, BodyIndex i, const Vector3& point) const {
    const std::size_t k = place(i);
    return v[k].at(point, states[k].pose.position);
  }
};

/// A contact of which at least one body hangs on joints.
struct JointedContact {
  StruckIsland of_a;
  StruckIsland of_b;   ///< empty where both are in one island
  double given = 0.0;  ///< parting speed by a unit impulse, 1/kg

  JointedContact(const Model& model, const EventMotions& motions, const Event& event)
      : of_a(model, motions, event.a) {
    const auto& [point, normal] = std::pair(event.contact.point, event.contact.normal);
    if (!of_a.holds(event.b)) {
      of_b = StruckIsland(model, motions, event.b);
    }
    StruckIsland& with_b = of_a.holds(event.b) ? of_a : of_b;
    if (of_a.island != nullptr) {
      of_a.push(event.a, point, -normal);
    }
    if (with_b.island != nullptr) {
      with_b.push(event.b, point, normal);
    }
    of_a.pass_on(event.time);
    of_b.pass_on(event.time);
    if (of_a.island != nullptr) {
      given -= normal.dot(of_a.at(of_a.response, event.a, point));
    }
    if (with_b.island != nullptr) {
      given += normal.dot(with_b.at(with_b.response, event.b, point));
    }
  }
};

}  // namespace

const JointSystem* EventContacts::joints_of(BodyIndex i) const {
  if (run_.model.scene().joints.empty()) {
    return nullptr;
  }
  return run_.model.is_free(i) ? run_.model.islands()[run_.model.island_of(i)].joints : nullptr;
}

/// Ends all contacts of the bodies that joints hold together with i.
void EventContacts::part_jointed(BodyIndex i, Instant t) {
  modes_.tell(modes_.part(motions_.island(i)), t);
}

/// Newton's hypothesis, with the effective mass that the joints leave at the contact: the two part
/// e times as fast as they met, and the joints take the impulses that this needs.
void EventContacts::strike_jointed(Event& event) {
  const Model& model = run_.model;
  for (const BodyIndex i : {event.a, event.b}) {
    if (joints_of(i) != nullptr) {
      motions_.put_onto_joints(i, event.time);
    }
  }
  event.contact.restitution = model.restitution(event.a, event.b);
  event.before_a = motions_.now(event.a);
  event.before_b = motions_.now(event.b);
  const double u = normal_velocity(event.contact, event.before_a, event.before_b);
  if (u >= 0.0) {
    // They came together only by what they were off their joints.
    event.after_a = event.before_a;
    event.after_b = event.before_b;
    return;
  }
  const JointedContact struck(model, motions_, event);
  const double p = struck.given > 0.0 ? -(1.0 + event.contact.restitution) * u / struck.given : 0.0;
  for (const StruckIsland* side : {&struck.of_a, &struck.of_b}) {
    for (std::size_t k = 0; k < side->states.size(); ++k) {
      const BodyIndex i = side->island->bodies[k];
      BodyState& now = motions_.now(i);
      now.twist.linear += p * side->response[k].linear;
      now.twist.angular += p * side->response[k].angular;
      run_.account.struck(i, side->states[k], now);
    }
  }
  event.after_a = motions_.now(event.a);
  event.after_b = motions_.now(event.b);
  const auto of_driver = [&](BodyIndex i, double sign) {
    const BodyState& now = motions_.now(i);
    return model.mobility(i) == Mobility::driven
               ? sign * p *
                     event.contact.normal.dot(now.twist.at(event.contact.point, now.pose.position))
               : 0.0;
  };
  const double v = normal_velocity(event.contact, event.after_a, event.after_b);
  run_.ledger.add(EnergyLine::restitution_loss, 0.5 * p * (u + v));
  run_.ledger.add(EnergyLine::driven_work, p * (struck.of_a.driven + struck.of_b.driven) +
                                               of_driver(event.a, -1.0) + of_driver(event.b, 1.0));
  ++run_.cost.impacts;
  run_.note(event);
}

/// Whether a body that hangs on joints comes to rest on a fixed one: its hops are too small to
/// resolve, and contact and joints leave it no freedom to move. The time of the hops that are left,
/// each e times as long as the one before, is summed up.
bool EventContacts::rest_on_joints(const Event& event, Instant t) {
  const bool a_is_free = run_.model.is_free(event.a);
  const BodyIndex body = a_is_free ? event.a : event.b;
  const BodyIndex other = a_is_free ? event.b : event.a;
  if (joints_of(body) == nullptr || joints_of(body)->driven() ||
      run_.model.mobility(other) != Mobility::fixed) {
    return false;
  }
  const JointedContact touching(run_.model, motions_, event);
  const StruckIsland& side = a_is_free ? touching.of_a : touching.of_b;
  const double sign = a_is_free ? -1.0 : 1.0;
  Island island = *side.island;
  std::vector<BodyState> still = side.states;
  std::vector<Twist> velocities;
  for (std::size_t k = 0; k < still.size(); ++k) {
    velocities.push_back(still[k].twist);
    still[k].twist = {};
    island.constant_force[k] = motions_.steady_force(island.bodies[k]);
  }
  std::vector<Wrench> wrenches(still.size());
  island.wrenches(t, still, wrenches);
  std::vector<Twist> loads(still.size());
  for (std::size_t k = 0; k < still.size(); ++k) {
    loads[k].linear = wrenches[k].force / island.inertia[k].mass;
    if (island.inertia[k].rotates) {
      loads[k].angular = angular_acceleration(island.inertia[k], still[k], wrenches[k].torque);
    }
  }
  const auto parting = [&](std::span<const Twist> rates) {
    return sign * event.contact.normal.dot(side.at(rates, body, event.contact.point));
  };
  /// Whether the contact takes up these rates entirely.
  const auto taken_up = [&](std::span<const Twist> rates) {
    const double share = parting(rates) / touching.given;
    double left = 0.0;
    double all = 0.0;
    for (std::size_t k = 0; k < still.size(); ++k) {
      const double radius = island.inertia[k].bounding_radius;
      const Twist& by = side.response[k];
      left = std::max({left, (rates[k].linear - share * by.linear).norm(),
                       radius * (rates[k].angular - share * by.angular).norm()});
      all = std::max({all, rates[k].linear.norm(), radius * rates[k].angular.norm()});
    }
    return left <= at_rest * all;
  };
  const double pressing = -parting(loads);
  const double e = event.contact.restitution;
  const double rebound = std::max(parting(velocities), 0.0);
  const double hop = small_hop * std::min(smallest_extent(run_.model.shape(event.a)),
                                          smallest_extent(run_.model.shape(event.b)));
  const bool dies_down = e < 1.0 && pressing > 0.0 && rebound * rebound <= 2.0 * pressing * hop;
  if (!dies_down || !taken_up(loads) || !taken_up(velocities)) {
    return false;
  }
  for (std::size_t k = 0; k < still.size(); ++k) {
    const BodyIndex i = island.bodies[k];
    run_.ledger.add(EnergyLine::zeno_completion, run_.account.gained(i, motions_.now(i), still[k]));
    run_.account.struck(i, motions_.now(i), still[k]);
    motions_.now(i) = still[k];
  }
  motions_.rest(body, t);
  modes_.join(event.a, event.b, t, 2.0 * rebound / (pressing * (1.0 - e)));
  predictor_.predict_island(body, t);
  return true;
}

}  // namespace core
}  // namespace kairos
