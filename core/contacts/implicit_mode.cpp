#include "core/contacts/implicit_mode.hpp"

#include "core/contacts/contact_sweeps.hpp"
#include "core/contacts/least_norm.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

using Does = FrictionChoice::Does;
using Vector6 = ContactSweeps::Vector6;

/// Sweeps have settled that change velocities by less than this part of what the loads do in the
/// step, and of the fastest. What is left along the normals is projected out.
constexpr double settled = 1e-10;
/// What has not come so far is refused. It is of the order of what the step itself is off.
constexpr double accepted = 1e-3;
/// What parts slower than this, in the same units, is held, and what slides slower sticks.
constexpr double held = 1e-7;
/// Impulses of redundant touches that are so many times what the loads give to all bodies in the
/// step are known to no digit, and what they do against each other as the bodies turn is no less.
constexpr double absurd = 1e5;
/// They may be so many times what stops all bodies: a rough touch that slips has to stop, however
/// short the step.
constexpr double stopping = 10.0;
/// An impulse that presses by less than this part of what it is presses by roundoff.
constexpr double rounded = 1e-14;
/// Work that is this part of what lifts bodies by their size is roundoff.
constexpr double unfelt = 64.0 * std::numeric_limits<double>::epsilon();
/// Friction that is bounded where none was.
constexpr double nearly_rough = 1e3;
/// So often forces are looked for at most.
constexpr int most_holds = 4;

/// What presses of an impulse, N s: of one along the surface nothing, whatever its components were
/// rounded to.
double pressing(const Vector3& normal, const Vector3& impulse) {
  const double along = normal.dot(impulse);
  return along > rounded * impulse.norm() ? along : 0.0;
}

/// Leaves nothing along the normals of what is held; returns the most that it changed, m/s.
double hold_normals(const TurningState& state, TurningMode& mode) {
  TurningState from = state;
  std::vector<TouchNow> now;
  for (std::size_t i = 0; i < from.states.size(); ++i) {
    from.states[i].twist = mode.velocities[i];
  }
  for (const Touch& touch : from.touches) {
    now.push_back(look_at(touch, from.states[touch.a], from.states[touch.b]));
  }
  std::vector<FrictionChoice> choices = mode.choices;
  for (FrictionChoice& choice : choices) {
    choice.does = choice.does == Does::opens ? Does::opens : Does::slides;
  }
  HeldVelocities none_left = held_velocities(from, now, choices);
  mode.velocities = std::move(none_left.of);
  mode.driven += none_left.driven;
  double most = 0.0;
  for (std::size_t i = 0; i < from.states.size(); ++i) {
    const Twist& was = from.states[i].twist;
    most = std::max(most, (mode.velocities[i].linear - was.linear).norm() +
                              state.radius[i] * (mode.velocities[i].angular - was.angular).norm());
  }
  return most;
}

/// What a touch does that took this impulse and has these rates at the end of the step, along its
/// normal and two tangents, m/s; what is slower than `least` is at rest. Among redundant touches
/// one may be at the edge of its cone and not slide.
FrictionChoice choice_of(double friction, const Vector3& normal, const Vector3& impulse,
                         const Vector3& rates, double least) {
  const bool rough = std::isinf(friction);
  const double pressed = pressing(normal, impulse);
  if (friction == 0.0 && pressed > 0.0) {
    return {Does::slides, Vector3::Zero()};
  }
  if (!(pressed > 0.0) && !(rough && !impulse.isZero(0.0))) {
    return {rates.x() <= least ? Does::slides : Does::opens, Vector3::Zero()};
  }
  if (friction > 0.0 && (rough || rates.tail<2>().norm() <= least)) {
    return {Does::sticks, Vector3::Zero()};
  }
  const Vector3 along = impulse - pressed * normal;
  return {Does::slides, along.isZero(0.0) ? along : Vector3(-along.normalized())};
}

/// Whether impulses of a step, which act from its start on, give energy at first, more than
/// `nothing` in a step: they push along what slides there, as up an incline on which it is held at
/// the end.
bool gives_energy(const TurningState& state, const ContactSweeps& sweeps,
                  std::span<const Vector3> impulses, const TurningMode& mode) {
  std::vector<Vector6> begin;
  for (const Twist& v : mode.velocities) {
    begin.push_back(stacked(v));
  }
  double given = 0.0;
  for (std::size_t k = 0; k < impulses.size(); ++k) {
    given +=
        impulses[k].dot(sweeps.axes(k).transpose() * sweeps.rate(k, begin) + state.touches[k].belt);
  }
  return given > mode.nothing;
}

double largest(std::span<const Vector3> impulses) {
  double most = 0.0;
  for (const Vector3& impulse : impulses) {
    most = std::max(most, impulse.norm());
  }
  return most;
}

/// Among the points of a pair that all stick, impulses that do the same can be shared in many ways:
/// here those of least norm, where these push within the cones. What the points do against each
/// other is nothing at the start of a step, but not in its course, as the bodies turn.
void share_alike(std::span<const Touch> touches, std::span<const SweptTouch> points,
                 std::vector<Vector3>& impulses) {
  const auto sticks = [&](std::size_t k, const Vector3& p) {
    const Vector3& n = points[k].normal;
    const double pressed = n.dot(p);
    return pressed > 0.0 && (p - pressed * n).norm() < points[k].friction * pressed;
  };
  std::size_t end = 0;
  for (std::size_t first = 0; first < touches.size(); first = end) {
    bool all = true;
    double reach = 0.0;
    for (end = first; end < touches.size() && touches[end].pair == touches[first].pair; ++end) {
      all = all && sticks(end, impulses[end]);
      reach = std::max(reach, (points[end].point_b - points[first].point_b).norm());
    }
    if (!all || !(reach > 0.0)) {
      continue;
    }
    const auto columns = static_cast<Eigen::Index>(3 * (end - first));
    Eigen::MatrixXd wrench(6, columns);  // a force, and its moment in units of `reach`
    Eigen::VectorXd now(columns);
    for (std::size_t k = first; k < end; ++k) {
      const auto at = static_cast<Eigen::Index>(3 * (k - first));
      const Vector3 arm = (points[k].point_b - points[first].point_b) / reach;
      wrench.block<3, 3>(0, at).setIdentity();
      for (int axis = 0; axis < 3; ++axis) {
        wrench.block<3, 1>(3, at + axis) = arm.cross(Vector3::Unit(axis));
      }
      now.segment<3>(at) = impulses[k];
    }
    const Eigen::VectorXd least = least_norm(wrench, wrench * now);
    const auto share = [&](std::size_t k) {
      return Vector3(least.segment<3>(static_cast<Eigen::Index>(3 * (k - first))));
    };
    for (std::size_t k = first; k < end; ++k) {
      all = all && sticks(k, share(k));
    }
    for (std::size_t k = first; k < end && all; ++k) {
      impulses[k] = share(k);
    }
  }
}

/// Friction without a bound holds along the surfaces what nothing presses. What parts all the same
/// does not go on so: the force of the step would act on the other alone. From here on its friction
/// is bounded: it parts by itself, or slides, hardly pressed. Whether some did.
bool let_part(std::span<const SweptTouch> touches, const ContactSweeps::Swept& swept,
              std::span<const Vector3> rates, double least, ContactSweeps& sweeps) {
  bool any = false;
  for (std::size_t k = 0; k < touches.size(); ++k) {
    if (std::isinf(sweeps.friction(k)) && !swept.impulse[k].isZero(0.0) &&
        !(pressing(touches[k].normal, swept.impulse[k]) > 0.0) &&
        (sweeps.rate(k, swept.velocities) + rates[k]).x() > least) {
      sweeps.set_friction(k, nearly_rough);
      any = true;
    }
  }
  return any;
}

/// Where that does not settle: they go on without friction. Whether there are some.
bool let_slide(std::span<const SweptTouch> touches, ContactSweeps& sweeps) {
  bool any = false;
  for (std::size_t k = 0; k < touches.size(); ++k) {
    if (std::isinf(touches[k].friction) && sweeps.friction(k) == nearly_rough) {
      sweeps.set_friction(k, 0.0);
      any = true;
    }
  }
  return any;
}

/// Where no impulses settle, as friction without a bound may have none that keep all: it is bounded
/// everywhere. Whether some was not.
bool bound_friction(ContactSweeps& sweeps, std::size_t touches) {
  bool any = false;
  for (std::size_t k = 0; k < touches; ++k) {
    if (std::isinf(sweeps.friction(k))) {
      sweeps.set_friction(k, nearly_rough);
      any = true;
    }
  }
  return any;
}

}  // namespace

TurningMode implicit_mode(const TurningState& state, double h, std::span<const Vector3> warm,
                          bool last_resort, int halvings, std::span<const Vector3> missed) {
  TurningMode mode;
  mode.implicit = true;
  const TurningForces forces(state);
  std::vector<SweptTouch> touches;
  std::vector<Vector3> begin;
  for (std::size_t k = 0; k < state.touches.size(); ++k) {
    const Touch& touch = state.touches[k];
    const TouchNow& now = forces.now()[k];
    touches.push_back({touch.a, touch.b, now.normal, now.point_a, now.point_b,
                       touch.rough ? std::numeric_limits<double>::infinity() : touch.friction});
    begin.push_back(k < warm.size() ? Vector3(h * warm[k]) : Vector3(Vector3::Zero()));
  }
  ContactSweeps sweeps(state.bodies, touches, state.joints);
  std::vector<Vector6> velocities;
  double fastest = 0.0;
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    const Twist& v = state.states[i].twist;
    velocities.push_back(stacked(v));
    fastest = std::max(fastest, v.linear.norm() + v.angular.norm() * state.radius[i]);
  }
  // Nothing approaches at the start.
  ContactSweeps::Swept stopped =
      sweeps.sweep(std::move(velocities), {}, {}, settled * fastest, false);
  velocities = std::move(stopped.velocities);
  for (const Vector3& impulse : stopped.impulse) {
    mode.struck.push_back(impulse.isZero(0.0) ? 0 : 1);
  }
  mode.driven =
      carrying_work(state, touches, stopped.impulse) + sweeps.driven_work(stopped.impulse);
  for (const Vector6& v : velocities) {
    mode.velocities.push_back({v.head<3>(), v.tail<3>()});
  }
  std::vector<Vector3> rates;
  for (std::size_t k = 0; k < touches.size(); ++k) {
    rates.emplace_back(h * (sweeps.axes(k) * forces.now()[k].bias));
    rates.back().x() = h * forces.now()[k].normal_bias;
    if (!state.touches[k].belt.isZero(0.0)) {
      rates.back().tail<2>() += (sweeps.axes(k) * state.touches[k].belt).tail<2>();
    }
    if (!missed.empty()) {
      rates.back() += sweeps.axes(k) * missed[k];
    }
  }
  const double scale =
      forces.load() * h + fastest * std::numeric_limits<double>::epsilon() / settled;
  double moved = 0.0;   // kg
  double lifted = 0.0;  // J
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    const double m = moves(state.bodies[i]) ? 1.0 / state.bodies[i].inverse_mass : 0.0;
    moved += m;
    lifted += m > 0.0 ? m * state.loads[i].linear.norm() * state.radius[i] : 0.0;
  }
  mode.nothing = held * moved * scale * scale + unfelt * lifted;
  ContactSweeps::Swept swept;
  // What holding normals takes from velocities, forces do not: they are looked for again.
  double taken = 0.0;
  for (int round = 0; round == 0 || (round < most_holds && taken > held * scale); ++round) {
    for (std::size_t i = 0; i < velocities.size(); ++i) {
      const auto& [v, w] = mode.velocities[i];
      velocities[i] << v + h * state.loads[i].linear, w + h * state.loads[i].angular;
    }
    const auto sweep = [&] {
      swept = sweeps.sweep(velocities, rates, begin, settled * scale, true,
                           last_resort ? SweptFor::last_resort : SweptFor::step, halvings);
      mode.solves += swept.solves;
    };
    sweep();
    while (let_part(touches, swept, rates, held * scale, sweeps)) {
      sweep();
    }
    if (!(swept.changed <= accepted * scale) && let_slide(touches, sweeps)) {
      sweep();
    }
    if (!(swept.changed <= accepted * scale) && bound_friction(sweeps, touches.size())) {
      sweep();
    }
    if (!(swept.changed <= accepted * scale)) {
      mode.refusal = "impulses of contacts were looked for touch by touch, and did not settle";
      return mode;
    }
    if (largest(swept.impulse) > moved * std::max(absurd * scale, stopping * fastest)) {
      mode.refusal = "impulses of contacts that are redundant were found far too large";
      return mode;
    }
    mode.choices.clear();
    for (std::size_t k = 0; k < touches.size(); ++k) {
      mode.choices.push_back(choice_of(sweeps.friction(k), touches[k].normal, swept.impulse[k],
                                       sweeps.rate(k, swept.velocities) + rates[k], held * scale));
    }
    taken = hold_normals(state, mode);
    begin = swept.impulse;
  }
  mode.gives = gives_energy(state, sweeps, swept.impulse, mode);
  share_alike(state.touches, touches, swept.impulse);
  mode.flies = true;
  std::vector<Vector6> accelerations;
  for (const Twist& load : state.loads) {
    accelerations.push_back(stacked(load));
  }
  for (std::size_t k = 0; k < touches.size(); ++k) {
    mode.flies = mode.flies && mode.choices[k].does == Does::opens;
    mode.forces.force.emplace_back(swept.impulse[k] / h);
    sweeps.push(k, mode.forces.force.back(), accelerations);
    mode.foreseen.emplace_back(sweeps.axes(k).transpose() *
                               (sweeps.rate(k, swept.velocities) + rates[k]));
  }
  for (const Vector6& a : accelerations) {
    mode.forces.accelerations.push_back({a.head<3>(), a.tail<3>()});
  }
  return mode;
}

}  // namespace core
}  // namespace kairos
