// `EventContacts` when one of two bodies that strike hangs on joints: these pass the impact on.
#include "core/contacts/contact_system.hpp"
#include "core/contacts/routh_impact.hpp"
#include "core/joint_system.hpp"
#include "core/schemes/event/event_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
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

/// The bodies of a contact, and all that joints hold together with either.
struct StruckMechanisms {
  std::vector<BodyIndex> bodies;  ///< by place
  std::vector<BodyState> states;
  ContactSystem system;  ///< rows: along the normal of the contact and two tangents
  std::size_t a = 0;     ///< places of the two
  std::size_t b = 0;

  StruckMechanisms(const Model& model, const EventMotions& motions, const Event& event) {
    std::vector<GroupMechanism> mechanisms;
    const auto add_one = [&](BodyIndex i) {
      bodies.push_back(i);
      states.push_back(motions.now(i));
      system.bodies.push_back(group_body(model.inertia(i), states.back().pose));
    };
    for (const BodyIndex i : {event.a, event.b}) {
      if (place(i) < bodies.size()) {
        continue;
      }
      const Island* const island =
          model.is_free(i) ? &model.islands()[model.island_of(i)] : nullptr;
      if (island == nullptr || island->joints == nullptr) {
        add_one(i);
        continue;
      }
      GroupMechanism mechanism{{}, island->joints};
      for (const BodyIndex k : island->bodies) {
        mechanism.places.push_back(bodies.size());
        add_one(k);
      }
      mechanisms.push_back(std::move(mechanism));
    }
    a = place(event.a);
    b = place(event.b);
    system.joints = group_joints(mechanisms, event.time, states);
  }

  [[nodiscard]] std::size_t place(BodyIndex i) const {
    return static_cast<std::size_t>(std::find(bodies.begin(), bodies.end(), i) - bodies.begin());
  }
  /// `slip`: where they slide along each other.
  void look_along(const Vector3& point, const Vector3& n, const Vector3& slip) {
    const auto [t1, t2] = contact_tangents(system, a, b, point, n, slip);
    for (const Vector3& d : {n, t1, t2}) {
      system.add(a, b, point, d);
    }
  }
  [[nodiscard]] Vector3 along(const Vector3& v) const {
    return {system.rows[0].direction.dot(v), system.rows[1].direction.dot(v),
            system.rows[2].direction.dot(v)};
  }
  [[nodiscard]] Vector3 world(const Vector3& x) const {
    return x[0] * system.rows[0].direction + x[1] * system.rows[1].direction +
           x[2] * system.rows[2].direction;
  }
  [[nodiscard]] std::vector<Twist> velocities() const {
    std::vector<Twist> v;
    for (const BodyState& s : states) {
      v.push_back(s.twist);
    }
    return v;
  }
  /// They go on with these velocities.
  void put(const std::vector<Twist>& v, EventRun& run, EventMotions& motions) const {
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      if (run.model.is_free(bodies[k])) {
        BodyState& now = motions.now(bodies[k]);
        now.twist = v[k];
        run.account.struck(bodies[k], states[k], now);
      }
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

/// Ends all contacts of the bodies that hang together with i.
void EventContacts::part_hanging(BodyIndex i, Instant t) {
  modes_.tell(modes_.part(motions_.island(i)), t);
}

/// The velocities of the two of an impact, and of all that hangs together with them. Of what an
/// impulse does to a light body by itself, joints to a heavy one may leave little: the roundoff of
/// the rest would be a part of it.
void EventContacts::put_onto_joints(const Event& event) {
  for (const BodyIndex i : {event.a, event.b}) {
    if (joints_of(i) != nullptr) {
      motions_.put_onto_joints(i, event.time);
    }
  }
}

/// Newton's hypothesis, with the effective mass that the joints leave at the contact: the two part
/// e times as fast as they met, and the joints take the impulses that this needs.
void EventContacts::strike_jointed(Event& event) {
  const Model& model = run_.model;
  put_onto_joints(event);
  event.contact.restitution = model.restitution(event.a, event.b);
  event.contact.friction = model.friction(event.a, event.b);
  event.before_a = motions_.now(event.a);
  event.before_b = motions_.now(event.b);
  if (event.contact.friction > 0.0) {
    return rub_jointed(event);
  }
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
                                               of_driver(event.a, 1.0) + of_driver(event.b, -1.0));
  ++run_.cost.impacts;
  run_.note(event);
}

/// The same with friction, as a motion in the normal impulse (`routh_impact`): the contact feels
/// what joints leave of an impulse in every direction.
void EventContacts::rub_jointed(Event& event) {
  StruckMechanisms struck(run_.model, motions_, event);
  const Vector3& n = event.contact.normal;
  const auto belt = [&](BodyIndex i) {
    const Vector3 v = run_.model.entity(i).surface_velocity(run_.model.body(i), motions_.now(i));
    return Vector3(v - n * n.dot(v));
  };
  const Vector3 belt_a = belt(event.a);
  const Vector3 belt_b = belt(event.b);
  const Vector3& point = event.contact.point;
  const auto at_point = [&](const BodyState& s) { return s.twist.at(point, s.pose.position); };
  const Vector3 u = (at_point(event.before_b) + belt_b) - (at_point(event.before_a) + belt_a);
  // Of the speed at which they slide, what joints without a drive leave.
  const auto left = [&](const BodyState& state_a, const BodyState& state_b) {
    Vector3 sum = Vector3::Zero();
    for (const auto& [i, state, sign] :
         {std::tuple{event.a, &state_a, -1.0}, {event.b, &state_b, 1.0}}) {
      const JointSystem* const joints = joints_of(i);
      if (joints != nullptr && !joints->driven()) {
        sum += sign * at_point(*state);
      }
    }
    return sum;
  };
  struck.look_along(point, n, u);
  const Vector3 before = struck.along(u);
  const Eigen::Matrix3d W = struck.system.coupling();
  RouthImpact impact;
  if (before[0] < 0.0 && W(0, 0) > 0.0) {
    impact = routh_impact(W, before, event.contact.friction, event.contact.restitution,
                          at_point(event.before_a).norm() + at_point(event.before_b).norm());
  }
  if (impact.solved) {
    std::vector<Twist> v = struck.velocities();
    struck.system.push(impact.impulse, v);
    struck.put(v, run_, motions_);
    put_onto_joints(event);
    // What the impulse did in all is told by the speeds that joints left better than by W.
    const Vector3 after = struck.along((at_point(motions_.now(event.b)) + belt_b) -
                                       (at_point(motions_.now(event.a)) + belt_a));
    double whole = 0.5 * impact.impulse.dot(before + after);
    double rubbed = impact.friction_work;
    // What joints block goes to their fixed sides, and does no work on what they leave of a speed.
    const Vector3 left_before = struck.along(left(event.before_a, event.before_b));
    const Vector3 left_after = struck.along(left(motions_.now(event.a), motions_.now(event.b)));
    for (const Eigen::Index i : {1, 2}) {
      if (W(i, i) == 0.0) {
        whole -= 0.5 * impact.impulse[i] * (left_before[i] + left_after[i]);
        rubbed -= impact.impulse[i] * left_before[i];
      }
    }
    run_.ledger.add(EnergyLine::restitution_loss, whole - rubbed);
    run_.ledger.add(EnergyLine::impact_friction, rubbed);
    const Vector3 p = struck.world(impact.impulse);
    const auto of_driver = [&](BodyIndex i, double sign) {
      return run_.model.mobility(i) == Mobility::driven ? sign * p.dot(at_point(motions_.now(i)))
                                                        : 0.0;
    };
    run_.ledger.add(EnergyLine::driven_work, struck.system.driven_work(impact.impulse) +
                                                 of_driver(event.a, 1.0) +
                                                 of_driver(event.b, -1.0));
    run_.ledger.add(EnergyLine::conveyor_and_hand, p.dot(belt_a) - p.dot(belt_b));
  }
  // One that was not solved goes on approaching, which the run tells.
  event.after_a = motions_.now(event.a);
  event.after_b = motions_.now(event.b);
  if (impact.solved || before[0] < 0.0) {
    ++run_.cost.impacts;
    run_.note(event);
  }
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
  if (run_.model.friction(body, other) > 0.0 &&
      !run_.model.entity(other)
           .surface_velocity(run_.model.body(other), motions_.now(other))
           .isZero(0.0)) {
    return false;  // at rest, it is still rubbed
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
