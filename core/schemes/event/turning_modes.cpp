// What `EventModes` does with groups whose bodies turn while they touch.
#include "core/contacts/jam.hpp"
#include "core/schemes/event/gathered_group.hpp"
#include "core/schemes/event/mode_guards.hpp"
#include "core/schemes/event/turning_group.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Steps that are shorter than this part of a frame are short: see `TurningLimits`.
constexpr double short_step = 1e-4;
/// The same on joints, among which a step costs several times as much.
constexpr double short_on_joints = 1e-3;
/// On joints searches for forces are halved so many times from the first: a solve costs several
/// times as much, and what is not found is stepped over.
constexpr int halvings_on_joints = 2;
/// Steps are not shortened below this part of a frame to end where bodies still touch.
constexpr double least_in_touch = 1e-9;

}  // namespace

/// Whether what holds the two is pressed.
bool EventModes::presses(const Gathered& found, const Turning& turning, const BodyPair& pair) {
  for (std::size_t k = 0; k < turning.mode.choices.size(); ++k) {
    const auto& [a, b] = found.pairs[turning.group.start.touches[k].pair];
    const bool same =
        (pair.first == a && pair.second == b) || (pair.first == b && pair.second == a);
    if (same && !turning.mode.forces.force[k].isZero(0.0)) {
      return true;
    }
  }
  return false;
}

bool EventModes::settle_turning(std::span<const BodyIndex> seeds, Instant t, const Adopt& adopt,
                                const SettleOptions& asked) {
  if (!stepper_) {
    return false;
  }
  const std::string flat = why_not_;
  SettleOptions options = asked;
  options.turning = true;
  Gathered found;
  Turning turning;
  if (!make_room(seeds, t, options, found, turning)) {
    return false;
  }
  why_not_ = add_rims(found, turning);
  if (!why_not_.empty()) {
    return false;
  }
  if (turning.group.start.touches.empty()) {
    why_not_ = flat;
    turning.mode.velocities = found.group.velocities;
    return turned(seeds) && !asked.pressed && !asked.unloaded && fly(found, turning, t, adopt);
  }
  const double frame = run_.options.step > 0.0 ? run_.options.step : run_.mean_frame;
  const double longest = std::min({frame, given_until(turning) - t, next_step(found)});
  const bool steps_over = asked.step_over || goes_on_implicitly(found, t);
  if (!steps_over) {
    find_forces(found, turning, t);
  }
  if ((steps_over || !turning.mode.refusal.empty()) && !step_over(found, turning, t, asked)) {
    return false;
  }
  const auto& forces = turning.mode.forces.force;
  const bool pressed =
      std::any_of(forces.begin(), forces.end(), [](const Vector3& f) { return !f.isZero(0.0); });
  if ((turning.mode.flies || !pressed) && !turning.all) {
    why_not_ = "nothing presses";
    if (!asked.may_part) {
      return false;
    }
    if (asked.may_turn && !asked.pressed) {
      return part_ways(found, turning, t, adopt);
    }
    return turning.mode.flies && turned(seeds) && !asked.pressed && !asked.unloaded &&
           fly(found, turning, t, adopt);
  }
  if (asked.pressed && !presses(found, turning, *asked.pressed)) {
    why_not_ = "nothing presses";
    return false;
  }
  FlatMode jump;
  jump.velocities = turning.mode.velocities;
  if (!completes(found, jump, asked, &turning)) {
    return false;
  }
  if (!turning.mode.implicit && short_steps(found) > TurningLimits::most_short_steps) {
    why_not_ = "what begins to slide, or stops, turns its direction faster than steps can follow";
    return false;
  }
  if (!turning.mode.implicit) {
    double h = longest;
    do {
      const std::unique_ptr<Stepper> stepper = stepper_(h);
      turning.step = turning_step(turning.group, turning.mode, *stepper, t, h);
      turning.step.halved = turning.step.halved || h < longest;
      h = 0.5 * turning.step.duration;
    } while (h > least_in_touch * frame && !ends_in_touch(found, turning));
    if (!(turning.step.duration > 0.0)) {
      turning.mode.refusal = turning.step.refusal.empty()
                                 ? "a corner of a body in touch is to strike at once"
                                 : turning.step.refusal;
      if (!step_over(found, turning, t, asked) || turning.mode.flies) {
        return false;
      }
    }
  }
  count_step(found, t);
  ++run_.cost.steps;
  run_.cost.right_hand_sides += turning.step.evaluations;
  tell_jam(found, turning, t);
  carry_on(found, turning, t, adopt);
  return true;
}

/// Up to when it is known how what is driven moves.
Instant EventModes::given_until(const Turning& turning) const {
  Instant until = run_.epoch_end();
  for (const GroupDriver& driver : turning.group.drivers) {
    until = std::min(until, driver.motion.end());
  }
  return until;
}

/// Whether what is held where edges cross, which moves along them and is no rim, still touches at
/// the end of a step.
bool EventModes::ends_in_touch(const Gathered& found, const Turning& turning) const {
  const std::vector<Touch>& touches = turning.group.start.touches;
  for (std::size_t k = 0; k < touches.size(); ++k) {
    const Touch& touch = touches[k];
    const BodyIndex a = found.bodies[touch.a];
    const BodyIndex b = found.bodies[touch.b];
    const auto ends_nowhere = [&](BodyIndex i) {
      return std::holds_alternative<HalfSpace>(run_.model.shape(i));
    };
    if (!turning.group.rims[k].empty() || ends_nowhere(a) || ends_nowhere(b) ||
        turning.mode.choices[k].does == FrictionChoice::Does::opens) {
      continue;
    }
    const Overlap end =
        run_.detector.overlap(run_.model.shape(a), turning.step.states[touch.a].pose,
                              run_.model.shape(b), turning.step.states[touch.b].pose);
    if (end.gap > predictor_.touching_gap(a, b)) {
      return false;
    }
  }
  return true;
}

/// Whether some of a group hang on joints.
bool EventModes::has_joints(const Gathered& found) {
  return std::any_of(found.mechanisms.begin(), found.mechanisms.end(),
                     [](const GroupMechanism& m) { return m.joints != nullptr; });
}

/// Forces at this instant; why there are none is the mode's refusal.
void EventModes::find_forces(const Gathered& found, Turning& turning, Instant t) {
  double fastest = 0.0;
  for (std::size_t k = 0; k < found.bodies.size(); ++k) {
    const Twist& v = found.states[k].twist;
    fastest = std::max(fastest, v.linear.norm() + v.angular.norm() * found.group.radius[k]);
  }
  const double roundoff = 64.0 * epsilon * fastest;
  const double still = TurningForces(turning.group.start).load() * found.group.instant + roundoff;
  const auto find = [&] {
    const int fewer = has_joints(found) ? halvings_on_joints : 0;
    turning.mode = turning_mode(
        turning.group.start, std::max(still, turning_rest(turning.group)),
        std::min(halvings(found, t, &Turned::in_vain) + fewer, TurningLimits::most_halvings));
    if (turning.mode.searched) {
      count_in_vain(found, turning, t, &Turned::in_vain);
    }
    return turning.mode.refusal.empty();
  };
  if (find()) {
    if (slides_roughly(turning, still)) {
      let_jam(found, turning, t, still);
    }
    return;
  }
  const TurningGroup all = turning.group;
  if (let_hop(turning, roundoff) && find()) {
    return;
  }
  let_jam(found, turning, t, still);
  if (!turning.mode.refusal.empty()) {
    turning.group = all;
  }
}

/// What parts slower than a hop worth the name is taken for rest. Where that contradicts itself it
/// hops: touches that part faster than `roundoff`, m/s, are none; false if there are none of these,
/// or no others.
bool EventModes::let_hop(Turning& turning, double roundoff) {
  TurningGroup& group = turning.group;
  std::vector<Touch> touches;
  std::vector<std::vector<TouchRim>> rims;
  for (std::size_t k = 0; k < group.start.touches.size(); ++k) {
    const Touch& touch = group.start.touches[k];
    const TouchNow now = look_at(touch, group.start.states[touch.a], group.start.states[touch.b]);
    if (now.normal.dot(now.velocity) <= roundoff) {
      touches.push_back(touch);
      rims.push_back(group.rims[k]);
    }
  }
  if (touches.empty() || touches.size() == group.start.touches.size()) {
    return false;
  }
  group.start.touches = std::move(touches);
  group.rims = std::move(rims);
  return true;
}

/// Whether something is pressed that slides with infinite friction.
bool EventModes::slides_roughly(const Turning& turning, double still) {
  for (std::size_t k = 0; k < turning.group.start.touches.size(); ++k) {
    const Touch& touch = turning.group.start.touches[k];
    const auto& states = turning.group.start.states;
    if (touch.rough && !turning.mode.forces.force[k].isZero(0.0)) {
      if (look_at(touch, states[touch.a], states[touch.b]).slip().norm() > still) {
        return true;
      }
    }
  }
  return false;
}

/// Where friction jams what slides, an impulse stops it, and it goes on from there.
void EventModes::let_jam(const Gathered& found, Turning& turning, Instant t, double still) {
  auto stopped = jam(turning.group.start, still, halvings(found, t, &Turned::in_vain));
  if (!stopped) {
    return;
  }
  TurningState after = turning.group.start;
  for (std::size_t k = 0; k < found.bodies.size(); ++k) {
    after.states[k].twist = stopped->velocities[k];
    after.loads[k] = load(found.bodies[k], after.states[k]);
  }
  if (!turning.group.mechanisms.empty()) {
    TurningGroup stopped_group = turning.group;
    stopped_group.start = after;
    after = turning_state(stopped_group, t, free_states(stopped_group));
  }
  TurningMode mode = turning_mode(after, std::max(still, turning_rest(turning.group)));
  if (mode.refusal.empty()) {
    turning.group.start = std::move(after);
    turning.mode = std::move(mode);
    turning.driven += stopped->driven;
    if (stopped->tangential) {
      turning.jammed = std::move(stopped->struck);
    }
  }
}

/// Records an impact of each pair that an impulse stopped, before what comes of it.
void EventModes::tell_jam(const Gathered& found, const Turning& turning, Instant t) {
  std::vector<char> told(found.pairs.size(), 0);
  for (std::size_t k = 0; k < turning.jammed.size(); ++k) {
    const Touch& touch = turning.group.start.touches[k];
    if (turning.jammed[k] == 0 || told[touch.pair] != 0) {
      continue;
    }
    told[touch.pair] = 1;
    const auto& [a, b] = found.pairs[touch.pair];
    const std::size_t at_a = found.place(a);
    const std::size_t at_b = found.place(b);
    const EventFlag flag = touch.rough ? EventFlag::none : EventFlag::painleve;
    Event event{.time = t, .kind = EventKind::impact, .flag = flag, .a = a, .b = b};
    const TouchNow now = look_at(touch, found.states[touch.a], found.states[touch.b]);
    event.contact = {0.5 * (now.point_a + now.point_b), now.normal, now.gap};
    event.contact.restitution = run_.model.restitution(a, b);
    event.contact.friction = run_.model.friction(a, b);
    event.before_a = event.after_a = found.states[at_a];
    event.before_b = event.after_b = found.states[at_b];
    event.after_a.twist = turning.mode.velocities[at_a];
    event.after_b.twist = turning.mode.velocities[at_b];
    ++run_.cost.impacts;
    run_.note(event);
  }
}

/// Nothing presses those that come to rest on each other: they go on by themselves, and none
/// approaches another any more.
bool EventModes::part_ways(const Gathered& found, Turning& turning, Instant t, const Adopt& adopt) {
  auto apart = parting(turning.group.start);
  if (!apart) {
    return false;
  }
  turning.mode.velocities = std::move(apart->velocities);
  turning.mode.struck = std::move(apart->struck);
  turning.mode.driven = apart->driven;
  return fly(found, turning, t, adopt);
}

/// By pair: whether an impulse stopped one of its touches.
std::vector<char> EventModes::struck_pairs(const Gathered& found, const Turning& turning) {
  std::vector<char> struck(found.pairs.size(), 0);
  for (std::size_t k = 0; k < turning.mode.struck.size(); ++k) {
    const std::size_t p = turning.group.start.touches[k].pair;
    struck[p] = struck[p] != 0 || turning.mode.struck[k] != 0 ? 1 : 0;
  }
  return struck;
}

/// How fast those that were not held yet still hop, m/s, by pair: what takes that from them
/// completes an accumulation. Of those that were held it is what steps were off.
std::vector<double> EventModes::hops(const Gathered& found) {
  std::vector<double> rates(found.pairs.size(), 0.0);
  for (std::size_t p = 0; p < found.pairs.size(); ++p) {
    const GroupPatch& patch = found.group.patches[p];
    if (found.passes[p] != 0 || graph_.joins(found.pairs[p].first, found.pairs[p].second)) {
      continue;
    }
    for (std::size_t k = 0; k < patch.manifold.size; ++k) {
      const Contact point{patch.manifold.points[k].position, patch.manifold.normal, 0.0};
      rates[p] = std::max(
          rates[p], std::abs(normal_velocity(point, found.states[patch.a], found.states[patch.b])));
    }
  }
  return rates;
}

/// Nothing holds the group any longer.
bool EventModes::fly(const Gathered& found, const Turning& turning, Instant t, const Adopt& adopt) {
  FlatMode mode;
  mode.turns = true;
  mode.grade = turning.mode.implicit ? Grade::stepped : Grade::sampled;
  mode.velocities = turning.mode.velocities;
  mode.driven = turning.driven + turning.mode.driven;
  mode.accelerations = found.group.loads;
  mode.kept.assign(found.pairs.size(), 0);
  mode.slip.assign(found.pairs.size(), Slip::none);
  mode.rate = hops(found);
  mode.struck = struck_pairs(found, turning);
  book_lift(found, t);
  commit(found, mode, t, adopt);
  return true;
}

/// The group moves on as the step found, and is looked at again where that ends.
void EventModes::carry_on(const Gathered& found, const Turning& turning, Instant t,
                          const Adopt& adopt) {
  const std::size_t n = found.pairs.size();
  FlatMode mode;
  mode.turns = true;
  mode.grade = turning.mode.implicit ? Grade::stepped : Grade::sampled;
  mode.velocities = turning.mode.velocities;
  mode.driven = turning.driven + turning.mode.driven;
  mode.accelerations = turning.mode.forces.accelerations;
  mode.kept.assign(n, 0);
  mode.pressing.assign(n, 0.0);
  mode.rate = hops(found);
  mode.struck = struck_pairs(found, turning);
  mode.slip.assign(n, Slip::none);
  mode.force.assign(n, Vector3::Zero());
  for (std::size_t k = 0; k < turning.step.choices.size(); ++k) {
    const FrictionChoice& c = turning.step.choices[k];
    const Touch& touch = turning.group.start.touches[k];
    using Does = FrictionChoice::Does;
    const std::size_t p = touch.pair;
    mode.kept[p] = c.does != Does::opens || turning.all ? 1 : mode.kept[p];
    if (c.does == Does::opens) {
      continue;
    }
    mode.force[p] += turning.mode.forces.force[k];
    mode.pressing[p] += found.group.patches[p].manifold.normal.dot(turning.mode.forces.force[k]);
    if (touch.friction > 0.0) {
      const Slip now = c.does == Does::sticks   ? Slip::sticks
                       : c.does == Does::begins ? Slip::begins
                                                : Slip::slides;
      mode.slip[p] = std::max(mode.slip[p], now);
    }
  }
  const std::pair<int, int> left = implicit_steps(found);
  book_lift(found, t);
  commit(found, mode, t, adopt, nullptr, &turning);
  if (turning.mode.implicit) {
    keep_forces(found, turning);
  }
  const double least = (has_joints(found) ? short_on_joints : short_step) * run_.mean_frame;
  for (const auto& [a, b] : found.pairs) {
    if (Patch* const patch = graph_.find(a, b)) {
      const double tried = turning.step.stepped;
      const bool is_short = tried < least;
      // Forces that hold for no time at all, again and again, are as good as none.
      const bool stalls = turning.step.end == TurningEnd::forces &&
                          turning.step.duration < least_in_touch * run_.mean_frame;
      patch->short_steps += stalls ? TurningLimits::of_stall : is_short ? 1 : -patch->short_steps;
      patch->step = turning.step.halved ? tried : std::max(patch->step, 2.0 * tried);
      count_implicit(turning, left, is_short, *patch);
    }
  }
  // Where what is driven goes on otherwise, what touches it is settled before, and the others here.
  const Instant given = given_until(turning);
  const Instant end = turning.step.duration < given - t ? t + turning.step.duration : given;
  const bool strikes = turning.step.end == TurningEnd::strike;
  if (strikes) {
    const auto& [a, b] = found.pairs[turning.step.pair];
    run_.agenda.push(end, DueKind::impact, a, b, 0.0, true);
  }
  end_together(found, mode, end, strikes);
}

/// What hangs together is looked at again at `end`. Where a strike ends the step that comes first,
/// before all of the group: what began anew before it would take those near with it, and put the
/// strike off, again and again. It may never come: what is held by neither may have been struck by
/// others before.
void EventModes::end_together(const Gathered& found, const FlatMode& mode, Instant end,
                              bool strikes) {
  std::vector<BodyIndex> told;
  for (std::size_t p = 0; p < found.pairs.size(); ++p) {
    const auto& [a, b] = found.pairs[p];
    const BodyIndex free = run_.model.is_free(a) ? a : b;
    if (mode.kept[p] != 0 && std::find(told.begin(), told.end(), free) == told.end()) {
      run_.agenda.push(end, strikes ? DueKind::step_ends : DueKind::mode_ends, a, b);
      for (const BodyIndex k : group(std::array{a, b})) {
        told.push_back(k);
      }
    }
  }
}

}  // namespace core
}  // namespace kairos
