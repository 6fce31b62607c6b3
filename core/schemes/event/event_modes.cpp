#include "core/schemes/event/event_modes.hpp"

#include "core/contacts/completion.hpp"
#include "core/contacts/group_impacts.hpp"
#include "core/schemes/event/gathered_group.hpp"
#include "core/schemes/event/mode_guards.hpp"
#include "core/schemes/event/turning_group.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

/// Points are off by the gaps that count as touch: so are impulses, by this part of the speeds.
constexpr double off_by_gaps = 1e-8;
/// What rocks in touch and is laid still comes to rest, which is told, where it was faster than
/// this part of the speeds, or of what a body gains that falls by its size: steps are off by less.
constexpr double off_by_steps = 1e-9;

}  // namespace

EventModes::EventModes(EventRun& run, EventMotions& motions, EventPredictor& predictor,
                       const EventAccumulation& accumulation, ContactGraph& graph,
                       std::function<std::unique_ptr<Stepper>(double)> stepper)
    : run_(run),
      motions_(motions),
      predictor_(predictor),
      accumulation_(accumulation),
      graph_(graph),
      stepper_(std::move(stepper)),
      has_turned_(run.model.size()) {
  const auto& islands = run.model.islands();
  some_hang_ = std::any_of(islands.begin(), islands.end(), hangs_together);
}

bool EventModes::settle(std::span<const BodyIndex> seeds, Instant t, const Adopt& adopt,
                        const SettleOptions& options) {
  not_by_pushing_ = false;
  if (settle_once(seeds, t, adopt, options)) {
    return true;
  }
  if (!not_by_pushing_) {
    return false;
  }
  SettleOptions fewer = options;
  const std::vector<BodyPair> apart = parting_pairs(seeds, t, options);
  if (!apart.empty()) {
    fewer.apart = apart;
    fewer.pairs -= std::min(fewer.pairs, apart.size());
    if (settle_once(seeds, t, adopt, fewer)) {
      return true;
    }
  }
  // Only what rests already is held: all else strikes.
  fewer.pairs = options.pairs;
  fewer.remaining = 0.0;
  return settle_once(seeds, t, adopt, fewer);
}

/// Which of those that an accumulation would unite part where all that approach stop at once, and
/// nothing is pulled [Moreau1988].
std::vector<BodyPair> EventModes::parting_pairs(std::span<const BodyIndex> seeds, Instant t,
                                                const SettleOptions& options) {
  const Gathered found = gather(seeds, t, options);
  if (!found.hangs.empty()) {
    return {};
  }
  ContactSystem system{found.group.bodies, {}};
  std::vector<std::size_t> first;
  for (const GroupPatch& patch : found.group.patches) {
    first.push_back(system.rows.size());
    for (std::size_t k = 0; k < patch.manifold.size; ++k) {
      system.add(patch.a, patch.b, patch.manifold.points[k].position, patch.manifold.normal);
    }
  }
  first.push_back(system.rows.size());
  std::vector<Twist> v = found.group.velocities;
  if (system.rows.empty() ||
      newton_group(system, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(first.back())), v)
              .size() == 0) {
    return {};
  }
  std::vector<BodyPair> apart;
  for (std::size_t p = 0; p < found.pairs.size(); ++p) {
    const double rest = found.group.patches[p].still_speed / still_part;
    bool parts = true;
    for (std::size_t r = first[p]; r < first[p + 1]; ++r) {
      parts = parts && system.rate(system.rows[r], v) > rest;
    }
    if (parts) {
      apart.push_back(found.pairs[p]);
    }
  }
  return apart;
}

bool EventModes::settle_once(std::span<const BodyIndex> seeds, Instant t, const Adopt& adopt,
                             const SettleOptions& options) {
  Gathered found = gather(seeds, t, options);
  why_not_ = found.refusal;
  if (!why_not_.empty()) {
    return false;
  }
  if (found.driven && found.hangs.empty() && !options.not_flat &&
      (let_go(found, t, adopt, options) || settle_driven(found, t, adopt, options))) {
    return true;
  }
  if (found.pairs.size() < options.pairs) {
    why_not_ = "some are still on their way";
    return false;
  }
  if (options.turning_only && !has_turned(seeds)) {
    return false;
  }
  if (found.driven) {
    return (options.may_turn || has_turned(seeds)) && settle_turning(seeds, t, adopt, options);
  }
  // What is stepped over hardly comes to lie flat from step to step.
  constexpr int tries_flat_every = 16;
  const bool steps_over = !options.unite && implicit_steps(found).first % tries_flat_every != 0;
  // Whether a face of many pieces still carries what turns takes longer to tell than a step.
  const bool by_pieces = !options.unite && pieces_turned(found, t) % tries_flat_every != 0;
  if (options.not_flat || steps_over || by_pieces) {
    return settle_turning(seeds, t, adopt, options);
  }
  if (!found.hangs.empty()) {
    why_not_ = found.hangs;
    return (options.may_turn || has_turned(seeds)) && settle_turning(seeds, t, adopt, options);
  }
  if (found.varies) {
    why_not_ = "'" + run_.model.body(*found.varies).name + "' feels forces that are not constant";
  } else if (options.turning_only) {
    why_not_ = contact_mode(found.group, {options.unloaded, options.unite}).refusal;
    if (why_not_.empty()) {
      return false;
    }
  } else if (settle_flat(std::move(found), t, adopt, options)) {
    return true;
  }
  return (options.may_turn || has_turned(seeds)) && settle_turning(seeds, t, adopt, options);
}

/// What carried it, and is driven, is slower all at once: it goes on by itself.
bool EventModes::let_go(const Gathered& found, Instant t, const Adopt& adopt,
                        const SettleOptions& options) {
  const bool was_held = std::any_of(found.bodies.begin(), found.bodies.end(), [&](BodyIndex i) {
    return i != *found.driven && graph_.joins(i, *found.driven);
  });
  if (!was_held || !found.pairs.empty() || !options.may_turn || options.unite || options.pressed) {
    return false;
  }
  FlatMode mode;
  mode.velocities = found.group.velocities;
  mode.accelerations = found.group.loads;
  commit(found, mode, t, adopt);
  return true;
}

/// Settles a group in which nothing turns; false, with `why_not_`, if something must.
bool EventModes::settle_flat(Gathered found, Instant t, const Adopt& adopt,
                             const SettleOptions& options) {
  while (why_not_.empty()) {
    FlatMode mode = contact_mode(found.group, {options.unloaded, options.unite});
    why_not_ = mode.refusal;
    if (mode.curved) {
      return settle_curved(found, t, adopt);
    }
    if (why_not_.empty() && options.pressed && !found.presses(*options.pressed, mode)) {
      why_not_ = "nothing presses";
    }
    if (!why_not_.empty()) {
      return false;
    }
    std::vector<double> until;
    why_not_ = guard_times(run_, found.bodies, found.states, found.group, mode,
                           run_.epoch_end() - t, until);
    if (!why_not_.empty()) {
      return false;
    }
    // A ball that is beyond the rim already is not carried: its patch goes.
    const auto over = std::find_if(until.begin(), until.end(),
                                   [&](double s) { return s <= at_once * run_.epoch(); });
    if (over != until.end()) {
      const auto p = over - until.begin();
      if (found.group.patches[static_cast<std::size_t>(p)].manifold.size > 1) {
        why_not_ = "a body tips over the rim of the body that carries it";
        return false;
      }
      found.group.patches.erase(found.group.patches.begin() + p);
      found.pairs.erase(found.pairs.begin() + p);
      continue;
    }
    if (!completes(found, mode, options)) {
      return false;
    }
    put_in_order(found, mode, t, options);
    commit(found, mode, t, adopt);
    for (std::size_t p = 0; p < until.size(); ++p) {
      run_.push_in_epoch(t + until[p], DueKind::mode_ends, found.pairs[p].first,
                         found.pairs[p].second);
    }
    for (std::size_t p = 0; p < mode.slip_ends.size(); ++p) {
      if (mode.kept[p] != 0) {
        run_.push_in_epoch(t + mode.slip_ends[p], DueKind::mode_ends, found.pairs[p].first,
                           found.pairs[p].second);
      }
    }
    return true;
  }
  return false;
}

/// Whether contacts can do what a mode asks of them that completes an accumulation: they push, and
/// never pull. Impacts that are left and end in touch have pushed only, all of them together; what
/// would have to be pulled has been taken for such, and turns, or parts.
bool EventModes::completes(const Gathered& found, const FlatMode& mode,
                           const SettleOptions& options, const Turning* turning) {
  if (!options.unite || !(options.remaining > 0.0)) {
    return true;  // nothing is faster than what rests may be
  }
  double rest = 0.0;
  double turning_apart = 0.0;
  for (std::size_t p = 0; p < found.pairs.size(); ++p) {
    if (found.passes[p] != 0) {
      continue;
    }
    const GroupPatch& patch = found.group.patches[p];
    rest = std::max(rest, patch.still_speed / still_part);
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (std::size_t k = 0; k < patch.manifold.size; ++k) {
      const double rate =
          normal_velocity({patch.manifold.points[k].position, patch.manifold.normal, 0.0},
                          found.states[patch.a], found.states[patch.b]);
      least = std::min(least, rate);
      most = std::max(most, rate);
    }
    turning_apart = std::max(turning_apart, most - least);
  }
  double fastest = 0.0;
  double change = 0.0;
  std::vector<Twist> before;
  for (std::size_t k = 0; k < found.bodies.size(); ++k) {
    const double r = found.group.radius[k];
    const Twist& was = found.states[k].twist;
    const Twist& is = mode.velocities[k];
    before.push_back(was);
    fastest = std::max(fastest, was.linear.norm() + r * was.angular.norm());
    change =
        std::max(change, (is.linear - was.linear).norm() + r * (is.angular - was.angular).norm());
  }
  const double allowed = rest + off_by_gaps * fastest;
  if (change <= allowed) {
    return true;
  }
  // Of a pair its nearest points were followed: others strike by themselves.
  if (turning_apart > allowed) {
    not_by_pushing_ = true;
    why_not_ = "what still bounces turns, and strikes at more than one point";
    return false;
  }
  std::vector<PushPoint> points;
  if (turning != nullptr) {
    const TurningState& start = turning->group.start;
    for (std::size_t k = 0; k < start.touches.size(); ++k) {
      const Touch& touch = start.touches[k];
      if (turning->mode.choices[k].does != FrictionChoice::Does::opens) {
        const TouchNow now = look_at(touch, start.states[touch.a], start.states[touch.b]);
        points.push_back(
            {touch.a, touch.b, now.point_a, now.normal, found.group.patches[touch.pair].friction});
      }
    }
  } else {
    for (std::size_t p = 0; p < found.pairs.size(); ++p) {
      const GroupPatch& patch = found.group.patches[p];
      for (std::size_t k = 0; k < patch.manifold.size && mode.kept[p] != 0; ++k) {
        points.push_back({patch.a, patch.b, patch.manifold.points[k].position,
                          patch.manifold.normal, patch.friction});
      }
    }
  }
  const double pull =
      pulled(found.group.bodies, found.group.radius, points, before, mode.velocities,
             turning != nullptr ? turning->group.start.joints.get() : nullptr);
  if (pull <= allowed) {
    return true;
  }
  not_by_pushing_ = true;
  why_not_ = "what still bounces would have to be pulled together";
  return false;
}

/// A mode that was found is what happens: the group jumps to it. Not by `jump`, for its bodies jump
/// together: their states were solved for together, all are booked and changed before the first is
/// launched, and all are launched before any is asked what it meets. `gather` has their states, so
/// nobody is brought again, which would undo an impact that led here.
void EventModes::commit(const Gathered& found, const FlatMode& mode, Instant t, const Adopt& adopt,
                        const GivenMotion* alone, const Turning* turning) {
  double dissipated = 0.0;
  for (std::size_t k = 0; k < found.bodies.size(); ++k) {
    const BodyIndex i = found.bodies[k];
    if (!run_.model.is_free(i)) {
      continue;
    }
    motions_.book(i, t);
    motions_.bring(i, t);
    if (const auto& support = motions_.support(i)) {
      const BodyIndex surface = support->surface;
      const auto pair =
          run_.agenda.before(i, surface) ? std::pair{i, surface} : std::pair{surface, i};
      Patch& patch = graph_.join(pair.first, pair.second);
      patch.begins = adopt(i);
      patch.told = patch.begins <= t;
      motions_.set_support(i, std::nullopt);
    }
    BodyState& now = motions_.now(i);
    now.pose = found.states[k].pose;
    BodyState before = now;
    before.twist = found.states[k].twist;
    now.twist = mode.velocities[k];
    dissipated += run_.account.gained(i, before, now);
    run_.account.struck(i, before, now);
  }
  if (mode.driven != 0.0) {
    run_.ledger.add(EnergyLine::driven_work, mode.driven);
    dissipated -= mode.driven;
  }
  if (dissipated != 0.0) {
    const bool hopped =
        found.remaining > 0.0 || mode.slip.empty() ||
        std::any_of(mode.rate.begin(), mode.rate.end(), [](double rate) { return rate > 0.0; });
    const bool jammed = turning != nullptr && !turning->jammed.empty();
    run_.ledger.add(jammed   ? EnergyLine::impact_friction
                    : hopped ? EnergyLine::zeno_completion
                             : EnergyLine::projection,
                    dissipated);
  }
  std::vector<Change> changes = join_and_part(found, mode, t);
  for (std::size_t k = 0; k < found.bodies.size(); ++k) {
    const BodyIndex i = found.bodies[k];
    if (run_.model.is_free(i)) {
      if (hangs_and_touches(i)) {
        go_on_hanging(found, k, t, turning);
      } else if (graph_.holds(i)) {
        Twist acceleration = mode.accelerations[k];
        if (mode.slip.empty() || found.group.round[k] == 0) {
          acceleration.angular.setZero();
        }
        if (turning != nullptr) {
          motions_.turn(i, t, turning->turn_of(k));
        } else if (alone != nullptr) {
          motions_.hold(i, t, alone->motion);
        } else {
          motions_.hold(i, t, acceleration);
        }
      } else {
        motions_.launch(i, t);
      }
    }
  }
  set_friction(found, mode, t, changes, alone, turning);
  tell(changes, t);
  for (const BodyIndex i : found.bodies) {
    if (run_.model.is_free(i)) {
      predictor_.predict(i, t);
    }
  }
}

/// What joints or forces hold together goes on together, with the first of its bodies.
void EventModes::go_on_hanging(const Gathered& found, std::size_t k, Instant t,
                               const Turning* turning) {
  const BodyIndex i = found.bodies[k];
  const std::vector<BodyIndex>& island = motions_.island(i);
  if (island.front() != i) {
    return;
  }
  if (turning == nullptr || !holds_island(i)) {
    return motions_.launch(i, t);
  }
  std::vector<EventMotions::Turn> turns;
  for (const BodyIndex mate : island) {
    turns.push_back(turning->turn_of(found.place(mate)));
  }
  motions_.turn_together(i, t, turns);
}

/// Velocity of the surface of i along itself, relative to body i, m/s: that of a belt.
Vector3 EventModes::belt(BodyIndex i, const Vector3& normal) const {
  const Vector3 v = run_.model.entity(i).surface_velocity(run_.model.body(i), motions_.now(i));
  return v - normal * normal.dot(v);
}

/// Which surfaces slide along or drive which from now on, and which of that is new.
void EventModes::set_friction(const Gathered& found, const FlatMode& mode, Instant t,
                              std::vector<Change>& changes, const GivenMotion* alone,
                              const Turning* turning) {
  for (std::size_t p = 0; p < mode.slip.size(); ++p) {
    if (mode.kept[p] == 0) {
      continue;
    }
    const auto [a, b] = found.pairs[p];
    const GroupPatch& patch = found.group.patches[p];
    const Vector3& n = patch.manifold.normal;
    const auto arm = [&](std::size_t k, double sign) {
      const double r = found.group.round[k] != 0 ? found.group.radius[k] : 0.0;
      return Vector3(sign * r * n);
    };
    const auto moves_by_itself = [&](BodyIndex i) { return !run_.model.is_free(i); };
    const Grade grade = mode.grade;
    Patch& held = *graph_.find(a, b);
    const Slip before =
        std::exchange(held.slip, mode.slip[p] == Slip::begins ? Slip::slides : mode.slip[p]);
    const Slip now = held.slip;
    if (!held.told) {
      // What it does is told when it begins.
    } else if (mode.slip[p] == Slip::begins || (now == Slip::slides && before != Slip::slides)) {
      changes.push_back({EventKind::slip_begins, a, b, grade});
    } else if (now == Slip::sticks && before == Slip::slides) {
      const bool rolls = (found.group.round[patch.a] != 0 && run_.model.rotates(a)) ||
                         (found.group.round[patch.b] != 0 && run_.model.rotates(b));
      changes.push_back({rolls ? EventKind::roll_begins : EventKind::stick_begins, a, b, grade});
    }
    // In an implicit step what sticks in the end may have slid.
    const bool rubs = turning != nullptr && turning->mode.implicit;
    if (now == Slip::slides || rubs || moves_by_itself(a) || moves_by_itself(b)) {
      const Vector3& force = mode.force[p];
      motions_.add_surface_force(
          run_.model.is_free(b) ? b : a, t,
          {.a = a,
           .b = b,
           .slides = now == Slip::slides,
           .rides = turning == nullptr && now != Slip::slides && found.driven.has_value(),
           .curved = turning != nullptr || (alone != nullptr && alone->curved),
           .force = force,
           .along = force - n * n.dot(force),
           .arm_a = arm(patch.a, 1.0),
           .arm_b = arm(patch.b, -1.0),
           .belt_a = belt(a, n),
           .belt_b = belt(b, n),
           .spent = turning != nullptr ? turning->step.rubbed[p]
                    : alone != nullptr ? alone->spent
                                       : Polynomial<3>()});
    }
  }
}

void EventModes::tell(std::span<const Change> changes, Instant t) {
  for (const Change& change : changes) {
    motions_.note({.time = t,
                   .kind = change.kind,
                   .grade = change.grade,
                   .bracket = change.bracket,
                   .a = change.a,
                   .b = change.b});
  }
}

/// Of two bodies the fastest, or what one gains that falls by its size if that is more, m/s.
double EventModes::speed(const Gathered& found, const GroupPatch& patch) {
  double fastest = 0.0;
  for (const std::size_t k : {patch.a, patch.b}) {
    const double r = found.group.radius[k];
    const auto& [v, w] = found.states[k].twist;
    fastest = std::max(
        {fastest, v.norm() + r * w.norm(), std::sqrt(found.group.loads[k].linear.norm() * r)});
  }
  return fastest;
}

/// Updates the contact graph; returns the contacts that end and those that begin now. Contacts
/// whose bounces have not died down begin later, by an event of their own.
std::vector<EventModes::Change> EventModes::join_and_part(const Gathered& found,
                                                          const FlatMode& mode, Instant t) {
  std::vector<Change> changes;
  std::vector<std::pair<BodyIndex, BodyIndex>> ended;
  for (const BodyIndex i : found.bodies) {
    for (const BodyIndex j : graph_.partners(i)) {
      const auto pair = run_.agenda.before(i, j) ? std::pair{i, j} : std::pair{j, i};
      const auto p = static_cast<std::size_t>(
          std::find(found.pairs.begin(), found.pairs.end(), pair) - found.pairs.begin());
      const bool stays = p < found.pairs.size() && mode.kept[p] != 0;
      if (run_.model.is_free(i) && !stays &&
          std::find(ended.begin(), ended.end(), pair) == ended.end()) {
        ended.push_back(pair);
      }
    }
  }
  for (const auto& [a, b] : ended) {
    const Patch patch = *graph_.find(a, b);
    graph_.part(a, b);
    if (patch.told) {
      changes.push_back({EventKind::contact_ends, a, b, patch.grade});
    }
  }
  for (std::size_t p = 0; p < found.pairs.size(); ++p) {
    const auto [a, b] = found.pairs[p];
    if (mode.kept[p] == 0) {
      const bool has_ended = std::find(ended.begin(), ended.end(), found.pairs[p]) != ended.end();
      if (p < mode.struck.size() && mode.struck[p] != 0 && !has_ended) {
        // It parts again, but for an instant it was in contact.
        changes.push_back({EventKind::contact_begins, a, b, mode.grade});
        changes.push_back({EventKind::contact_ends, a, b, mode.grade});
      }
      continue;
    }
    const bool is_new = !graph_.joins(a, b);
    Patch& patch = graph_.join(a, b);
    const bool comes_to_rest = patch.told && patch.turns && !mode.turns &&
                               mode.rate[p] > off_by_steps * speed(found, found.group.patches[p]);
    if (comes_to_rest) {
      changes.push_back({EventKind::contact_ends, a, b, patch.grade});
      patch.told = false;
    }
    patch.manifold = found.group.patches[p].manifold;
    patch.turns = mode.turns;
    patch.grade = mode.grade;
    if (!is_new && !comes_to_rest && !(mode.turns && !patch.told)) {
      continue;
    }
    const double e = run_.model.restitution(a, b);
    const std::size_t pa = found.place(a);
    const std::size_t pb = found.place(b);
    const Vector3& n = patch.manifold.normal;
    const double pressing =
        -std::min(n.dot(found.group.loads[pb].linear - mode.accelerations[pa].linear),
                  n.dot(mode.accelerations[pb].linear - found.group.loads[pa].linear));
    const bool hops = !mode.turns && mode.rate[p] > 0.0 && pressing > 0.0 && e < 1.0;
    const double still = hops ? 2.0 * mode.rate[p] / (pressing * (1.0 - e)) : 0.0;
    patch.begins = t + still;
    if (still > 0.0 && patch.begins < Instant::never()) {
      run_.agenda.push(patch.begins, DueKind::contact_begins, a, b);
    } else {
      patch.told = true;
      changes.push_back({EventKind::contact_begins, a, b, mode.grade,
                         mode.turns ? Event{}.bracket : found.remaining});
    }
  }
  return changes;
}

void EventModes::begin_contact(BodyIndex a, BodyIndex b, Instant t) {
  Patch* const patch = graph_.find(a, b);
  if (patch != nullptr && !patch->told && patch->begins == t) {
    run_.time = t;
    patch->told = true;
    motions_.note({.time = t, .kind = EventKind::contact_begins, .bracket = 0.0, .a = a, .b = b});
    if (patch->slip == Slip::slides) {
      motions_.note(EventKind::slip_begins, a, b, t);
    }
  }
}

void EventModes::join(BodyIndex i, BodyIndex j, Instant t, double remaining) {
  const auto [a, b] = run_.agenda.before(i, j) ? std::pair{i, j} : std::pair{j, i};
  Patch& patch = graph_.join(a, b);
  patch.begins = t + remaining;
  run_.agenda.push(patch.begins, DueKind::contact_begins, a, b);
}

std::vector<EventModes::Change> EventModes::part(std::span<const BodyIndex> bodies) {
  std::vector<Change> changes;
  for (const BodyIndex i : bodies) {
    while (graph_.holds(i)) {
      const BodyIndex j = graph_.partners(i).front();
      const Patch patch = *graph_.find(i, j);
      graph_.part(i, j);
      if (patch.told) {
        changes.push_back({EventKind::contact_ends, patch.a, patch.b});
      }
    }
  }
  return changes;
}

std::vector<BodyIndex> EventModes::moving() const {
  std::vector<BodyIndex> bodies;
  for (const BodyIndex i : run_.agenda.by_name()) {
    if (run_.model.is_free(i) && graph_.holds(i) && motions_.of(i).position.degree() > 0) {
      bodies.push_back(i);
    }
  }
  return bodies;
}

}  // namespace core
}  // namespace kairos
