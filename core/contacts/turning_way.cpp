#include "core/contacts/turning_way.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kairos {
inline namespace core {
namespace {

using Does = FrictionChoice::Does;

/// Of each body of a group among all of them.
std::vector<std::size_t> own_places(std::size_t n) {
  std::vector<std::size_t> places(n);
  std::iota(places.begin(), places.end(), std::size_t{0});
  return places;
}
/// Of sliding: along the velocity, and where that is hardly any, as it was.
Vector3 direction(const TouchNow& now, const Vector3& before, double slow) {
  const Vector3 u = now.slip();
  const double along = before.dot(u);
  const Vector3 d = before * std::max(along, slow) + (u - along * before);
  return (d - now.normal * now.normal.dot(d)).normalized();
}

}  // namespace

TurningWay::TurningWay(const TurningGroup& of, const TurningMode& in, Instant start)
    : group(of), mode(in), t(start), slow(slow_slip(of)) {
  for (std::size_t i = 0; i < group.bodies.size(); ++i) {
    if (group.inertia[i].mass > 0.0) {
      free.push_back(i);
    }
  }
}

std::vector<BodyState> TurningWay::free_states(double s) const {
  std::vector<BodyState> states;
  for (const Motion& motion : motions) {
    states.push_back({motion.pose(s), motion.twist(s)});
  }
  return states;
}

TurningState TurningWay::at(double s) const { return turning_state(group, t + s, free_states(s)); }

TurningState TurningWay::touching_at(double s) const {
  return touching_state(group, t + s, free_states(s));
}

TurningState touching_state(const TurningGroup& group, Instant t,
                            std::span<const BodyState> free_states) {
  TurningState state;
  state.radius = group.start.radius;
  state.touches = group.start.touches;
  std::size_t next = 0;
  for (std::size_t i = 0; i < group.bodies.size(); ++i) {
    const bool free = group.inertia[i].mass > 0.0;
    const auto driver = std::find_if(group.drivers.begin(), group.drivers.end(),
                                     [i](const GroupDriver& d) { return d.place == i; });
    const double moved = driver != group.drivers.end() ? t - driver->motion.start : 0.0;
    state.states.push_back(free ? free_states[next++]
                           : driver != group.drivers.end()
                               ? BodyState{driver->motion.pose(moved), driver->motion.twist(moved)}
                               : group.start.states[i]);
    state.bodies.push_back(group_body(group.inertia[i], state.states.back().pose));
  }
  return state;
}
std::vector<TouchNow> touches_of(const TurningState& state) {
  std::vector<TouchNow> now;
  for (const Touch& touch : state.touches) {
    now.push_back(look_at(touch, state.states[touch.a], state.states[touch.b]));
  }
  return now;
}
std::vector<FrictionChoice> directed(const TurningMode& mode, const std::vector<TouchNow>& now,
                                     double slow) {
  std::vector<FrictionChoice> choices = mode.choices;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    FrictionChoice& c = choices[k];
    if ((c.does == Does::slides || c.does == Does::begins) && !c.direction.isZero(0.0)) {
      c.direction = direction(now[k], c.direction, slow);
    }
  }
  return choices;
}
double slow_slip(const TurningGroup& group) {
  double size = 0.0;
  for (std::size_t i = 0; i < group.bodies.size(); ++i) {
    size = std::max(size, group.inertia[i].mass > 0.0 ? group.start.radius[i] : 0.0);
  }
  return 1e-5 * std::sqrt(TurningForces(group.start).load() * size);
}
std::vector<Vector3> carried_forces(const TurningGroup& group, const TurningMode& mode,
                                    const std::vector<TouchNow>& now) {
  std::vector<Vector3> out;
  for (std::size_t k = 0; k < now.size(); ++k) {
    const Touch& touch = group.start.touches[k];
    const Vector3 before =
        look_at(touch, group.start.states[touch.a], group.start.states[touch.b]).normal;
    const Vector3& f = mode.forces.force[k];
    const Vector3& n = now[k].normal;
    const double pressing = before.dot(f);
    const Vector3 along = f - pressing * before;
    out.push_back(pressing * n + (along - n * n.dot(along)));
  }
  return out;
}
Twist accelerations_of(const Motion& motion, Instant t) {
  const double s = t - motion.start;
  Twist out{motion.acceleration(s), Vector3::Zero()};
  if (motion.rotation != RotationKind::fixed) {
    out.angular = motion.angular_velocity.derivative(s);
  }
  return out;
}
TurningState turning_state(const TurningGroup& group, Instant t,
                           std::span<const BodyState> free_states) {
  TurningState state = touching_state(group, t, free_states);
  std::vector<Wrench> applied;
  for (std::size_t i = 0; i < group.bodies.size(); ++i) {
    const BodyState& s = state.states[i];
    applied.push_back({group.constant_force[i], Vector3::Zero()});
    if (group.inertia[i].mass > 0.0) {
      for (const Force* const force : group.forces[i]) {
        force->add(t, {&s, 1}, {&applied.back(), 1});
      }
    }
  }
  const auto load = [&](std::size_t i) {
    const BodyInertia& inertia = group.inertia[i];
    Twist out;
    if (inertia.mass > 0.0) {
      out.linear = applied[i].force / inertia.mass;
      if (inertia.rotates) {
        out.angular = angular_acceleration(inertia, state.states[i], applied[i].torque);
      }
    }
    return out;
  };
  for (const GroupMechanism& mechanism : group.mechanisms) {
    const std::vector<std::size_t> place = own_places(group.bodies.size());
    add_mechanism_forces(mechanism, place, false, t, state.states, applied);
    for (const std::size_t i : mechanism.places) {
      const Twist alone = load(i);
      state.applied =
          std::max(state.applied, alone.linear.norm() + alone.angular.norm() * state.radius[i]);
    }
    add_mechanism_forces(mechanism, place, true, t, state.states, applied);
  }
  for (std::size_t i = 0; i < group.bodies.size(); ++i) {
    state.loads.push_back(load(i));
  }
  for (const GroupDriver& driver : group.drivers) {
    state.loads[driver.place] = accelerations_of(driver.motion, t);
  }
  state.joints = group_joints(group.mechanisms, t, state.states);
  return state;
}
}  // namespace core
}  // namespace kairos
