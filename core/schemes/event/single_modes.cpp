// `EventModes` for one body on one surface whose motion is no parabola: the surface is driven, or
// the direction of sliding turns.
#include "core/contacts/centre_of_pressure.hpp"
#include "core/contacts/curved_slip.hpp"
#include "core/schemes/event/driven_mode.hpp"
#include "core/schemes/event/gathered_group.hpp"
#include "core/schemes/event/mode_guards.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
/// Settles one block on one driven face.
bool EventModes::settle_driven(Gathered found, Instant t, const Adopt& adopt,
                               const SettleOptions& options) {
  const BodyIndex surface = *found.driven;
  const bool alone = found.bodies.size() == 2 && found.pairs.size() == 1;
  const BodyIndex body = alone && found.bodies[0] == surface ? found.bodies[1] : found.bodies[0];
  if (!alone || !run_.model.is_free(body) || found.group.round[found.place(body)] != 0) {
    why_not_ = "'" + run_.model.body(surface).name + "' is driven";
    return false;
  }
  const std::size_t k = found.place(body);
  const GroupPatch& patch = found.group.patches[0];
  const bool first = patch.a == k;
  const Vector3 n = first ? Vector3(-patch.manifold.normal) : patch.manifold.normal;
  if (!(first ? patch.manifold.face_of_b : patch.manifold.face_of_a) || patch.manifold.size < 3 ||
      !found.states[k].twist.angular.isZero(0.0)) {
    why_not_ = "'" + run_.model.body(body).name + "' turns, or lies on no face";
    return false;
  }
  const Motion whole = motions_.of(surface);
  const Motion under = whole.shifted(std::min(t - whole.start, whole.duration));
  // The motion of the surface comes in pieces, each truncated at its order: their errors would add
  // up to penetration.
  double gap = 0.0;
  for (std::size_t p = 0; p < patch.manifold.size; ++p) {
    gap = std::min(gap, patch.manifold.points[p].gap);
  }
  Vector3& position = found.states[k].pose.position;
  const Vector3 before = position;
  position -= gap * n;
  DrivenMode driven =
      driven_mode({.body = found.states[k],
                   .load = found.group.loads[k].linear,
                   .normal = n,
                   .friction = patch.friction,
                   .still = found.group.loads[k].linear.norm() * found.group.instant,
                   .duration = run_.epoch_end() - t},
                  under);
  why_not_ = driven.refusal;
  if (!why_not_.empty()) {
    return false;
  }
  FlatMode mode;
  mode.velocities = found.group.velocities;
  mode.accelerations = found.group.loads;
  mode.kept = {0};
  if (driven.parts) {
    if (options.pressed) {
      why_not_ = "nothing presses";
      return false;
    }
    run_.account.moved(body, position - before);
    commit(found, mode, t, adopt);
    return true;
  }
  // The forces act where the line through the middle of the block, along their sum, meets the face.
  const ContactManifold& m = patch.manifold;
  const Vector3& middle = found.states[k].pose.position;
  const Vector3 down = m.normal * m.normal.dot(m.points[0].position - middle);
  const auto pressed = [&](double share) {
    return Vector3(middle + down - share * down.norm() * driven.leans);
  };
  if (!carries_at(m, pressed(1.0)) ||
      (driven.slip == Slip::sticks && !carries_at(m, pressed(-1.0)))) {
    why_not_ = "a body that is driven by friction could tip";
    return false;
  }
  if (driven.slip != Slip::sticks) {
    Motion point = driven.motion;
    point.position[0] = pressed(1.0);
    driven.until =
        std::min(driven.until, face_exit_time(run_.model.shape(surface), under, point, m.normal,
                                              m.points[0].position, driven.motion.duration));
    Motion slides = driven.motion;
    slides.start = t;
    why_not_ = meets_elsewhere(run_, {body, surface, Vector3(-n), m.points[0].position}, {slides},
                               {under}, t, slides.duration, driven.until);
    if (!why_not_.empty()) {
      return false;
    }
  }
  mode.velocities[k].linear = driven.velocity;
  mode.accelerations[k].linear += driven.pushes;
  const double mass = run_.model.inertia(body).mass;
  mode.kept = {1};
  mode.pressing = {mass * driven.pressing};
  mode.rate = {
      std::abs(patch.manifold.normal.dot(found.states[k].twist.linear - under.twist(0.0).linear))};
  mode.slip = {driven.slip};
  mode.force = {(first ? -mass : mass) * driven.pushes};
  mode.slip_ends = {driven.until};
  run_.account.moved(body, position - before);
  GivenMotion alone_there{driven.motion, false, {}};
  alone_there.motion.start = t;
  if (driven.worked) {
    alone_there.curved = true;
    alone_there.spent = *driven.worked;
    for (int j = 0; j <= alone_there.spent.degree(); ++j) {
      alone_there.spent[j] *= mass;
    }
  }
  commit(found, mode, t, adopt, &alone_there);
  run_.push_in_epoch(t + driven.until, DueKind::mode_ends, found.pairs[0].first,
                     found.pairs[0].second);
  return true;
}

/// Settles one body that slides on a fixed face along a curve: its direction is a series.
bool EventModes::settle_curved(const Gathered& found, Instant t, const Adopt& adopt) {
  const bool pair = found.bodies.size() == 2 && found.pairs.size() == 1;
  const std::size_t k = pair && run_.model.is_free(found.bodies[0]) ? 0 : 1;
  const GroupPatch* const patch = pair ? &found.group.patches[0] : nullptr;
  const bool first = pair && patch->a == k;
  const bool face = pair && (first ? patch->manifold.face_of_b : patch->manifold.face_of_a);
  if (!face || run_.model.is_free(found.bodies[1 - k]) || !patch->drift.isZero(0.0)) {
    why_not_ = "a body slides on a curved path among others, or on a belt";
    return false;
  }
  const GroupBody& body = found.group.bodies[k];
  const bool round = found.group.round[k] != 0;
  const Vector3 n = first ? Vector3(-patch->manifold.normal) : patch->manifold.normal;
  const Vector3& load = found.group.loads[k].linear;
  const double pressing = -load.dot(n);
  if (!(pressing > 0.0)) {
    why_not_ = "nothing presses";
    return false;
  }
  const double braked = patch->friction * pressing;
  Twist start = found.states[k].twist;
  start.linear -= n * n.dot(start.linear);
  // A ball turns, too: its point of contact is accelerated 1 + r * turned times as much as its
  // middle.
  const double r = round ? found.group.radius[k] : 0.0;
  const double turned = r * body.inverse_inertia(0, 0) / body.inverse_mass;
  Vector3 slip = start.linear + start.angular.cross(-r * n);
  slip -= n * n.dot(slip);
  const CurvedSlip curve =
      curved_slip(slip, load + pressing * n, braked * (1.0 + r * turned), run_.epoch_end() - t);

  GivenMotion alone{
      Motion::ballistic(t, curve.duration, found.states[k].pose, start, Vector3::Zero()), true, {}};
  const int order = curve.direction.degree();
  Motion& motion = alone.motion;
  motion.velocity.resize(order + 1);
  motion.position.resize(order + 2);
  alone.spent.resize(order + 1);
  if (turned > 0.0) {
    motion.rotation = RotationKind::constant_rate;  // its orientation is not followed
    motion.angular_velocity.resize(order + 1);
  }
  const double force = braked / body.inverse_mass;
  for (int j = 0; j <= order; ++j) {
    const Vector3 d = curve.direction[j];
    Vector3 a = -braked * d;
    a += j == 0 ? Vector3(load + pressing * n) : Vector3(Vector3::Zero());
    motion.velocity[j + 1] = a / (j + 1.0);
    motion.position[j + 2] = a / ((j + 1.0) * (j + 2.0));
    if (turned > 0.0) {
      motion.angular_velocity[j + 1] = (braked * turned / (j + 1.0)) * n.cross(d);
    }
    alone.spent[j + 1] = Vector3(-force * curve.speed[j].x() / (j + 1.0), 0.0, 0.0);
  }
  motion.position[1] = start.linear;

  // The point where the forces act: along their sum from the middle down to the face.
  Motion point = motion;
  const BodyIndex surface = found.bodies[1 - k];
  const Vector3& at = patch->manifold.points[0].position;
  double until = curve.duration;
  if (!round) {
    const Vector3 down = n * n.dot(patch->manifold.points[0].position - motion.position[0]);
    for (int j = 0; j <= order; ++j) {
      point.position[j] += down.norm() * patch->friction * Vector3(curve.direction[j]);
    }
    point.position[0] += down;
    until = std::min(until, face_exit_time(run_.model.shape(found.bodies[k]), motion, point, n, at,
                                           curve.duration));
  }
  until = std::min(until, face_exit_time(run_.model.shape(surface), motions_.of(surface), point, n,
                                         at, curve.duration));
  if (until <= at_once * run_.epoch() && until < curve.duration) {
    why_not_ = "a body begins to turn: it tips, or its support is beside its centre";
    return false;
  }
  const Moving slides{motion, round};
  why_not_ = meets_elsewhere(run_, {found.bodies[k], surface, Vector3(-n), at}, slides,
                             {motions_.of(surface)}, t, curve.duration, until);
  if (!why_not_.empty()) {
    return false;
  }
  FlatMode mode;
  mode.velocities = found.group.velocities;
  mode.velocities[k] = start;
  mode.accelerations = found.group.loads;
  mode.accelerations[k].linear += pressing * n - braked * Vector3(curve.direction[0]);
  mode.kept = {1};
  mode.pressing = {pressing / body.inverse_mass};
  mode.rate = {std::abs(n.dot(found.states[k].twist.linear))};
  mode.slip = {Slip::slides};
  mode.force = {Vector3::Zero()};
  mode.slip_ends = {until};
  commit(found, mode, t, adopt, &alone);
  why_not_.clear();
  run_.push_in_epoch(t + until, DueKind::mode_ends, found.pairs[0].first, found.pairs[0].second);
  return true;
}

}  // namespace core
}  // namespace kairos
