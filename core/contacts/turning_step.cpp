#include "core/contacts/turning_step.hpp"

#include "core/bent_motion.hpp"
#include "core/contacts/separation_watch.hpp"
#include "core/power_nodes.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

using Does = FrictionChoice::Does;

/// A mode goes on until a force is this much beyond its cone: what follows is then no tie.
constexpr double guard = 4.0 * turning_roundoff;
constexpr int samples = 16;  ///< of what may end the mode, in a step
constexpr int bisections = 48;
constexpr int most_halvings = 40;
/// Held gaps are off by no more than this part of what they are.
constexpr double drift = 0.1;
/// Of the gap below which corners strike: along the motions that are integrated, and a little less
/// once what they are off has been taken out, so that this hardly ever cuts them again.
constexpr double strike_gap = 0.9375;
constexpr double bent_gap = 0.875;
constexpr int few_cuts = 4;

/// What slides back has stopped: faster than this part of `slow_slip`.
constexpr double reversed = 1e-6;

/// What is to stick at the end of a step slides where it is faster than this part of what loads
/// give in the step.
constexpr double still_slides = 1e-3;

/// What is this part of its size beyond a rim is beyond it.
constexpr double over_rim = 1e-12;

/// The group at another instant as its touches see it: without loads and joints.
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

/// Its touches there.
std::vector<TouchNow> touches_of(const TurningState& state) {
  std::vector<TouchNow> now;
  for (const Touch& touch : state.touches) {
    now.push_back(look_at(touch, state.states[touch.a], state.states[touch.b]));
  }
  return now;
}

/// Of each body of a group among all of them.
std::vector<std::size_t> own_places(std::size_t n) {
  std::vector<std::size_t> places(n);
  std::iota(places.begin(), places.end(), std::size_t{0});
  return places;
}

/// Of sliding: along the velocity, and where that is hardly any, as it was.
Vector3 direction(const TouchNow& now, const Vector3& before, double slow) {
  const Vector3 u = now.velocity - now.normal * now.normal.dot(now.velocity);
  const double along = before.dot(u);
  const Vector3 d = before * std::max(along, slow) + (u - along * before);
  return (d - now.normal * now.normal.dot(d)).normalized();
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

/// Slower than this, m/s, what slides goes on as it did: a small part of what a body gains that
/// falls by its size. Directions of slower sliding change faster than steps can follow.
double slow_slip(const TurningGroup& group) {
  double size = 0.0;
  for (std::size_t i = 0; i < group.bodies.size(); ++i) {
    size = std::max(size, group.inertia[i].mass > 0.0 ? group.start.radius[i] : 0.0);
  }
  return 1e-5 * std::sqrt(TurningForces(group.start).load() * size);
}

/// Forces of an implicit step: they go with the normals, and are as large as they were.
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

/// Contact forces as a force of the island.
class ContactForce final : public Force {
 public:
  ContactForce(const TurningGroup& group, const TurningMode& mode)
      : group_(group), mode_(mode), slow_(slow_slip(group)) {}

  void add(Instant t, std::span<const BodyState> bodies,
           std::span<Wrench> wrenches) const override {
    if (mode_.implicit) {
      const TurningState state = touching_state(group_, t, bodies);
      const std::vector<TouchNow> now = touches_of(state);
      add_all(state, now, carried_forces(group_, mode_, now), wrenches);
      return;
    }
    const TurningState state = turning_state(group_, t, bodies);
    TurningForces forces(state);
    add_all(state, forces.now(),
            forces
                .solve(directed(mode_, forces.now(), slow_),
                       forces.of_several(TurningForces::Which::some_of_many))
                .force,
            wrenches);
  }
  [[nodiscard]] double potential(Instant, std::span<const BodyState>) const override { return 0.0; }
  [[nodiscard]] bool conservative() const override { return false; }
  [[nodiscard]] std::string description() const override { return "what holds bodies in touch"; }

 private:
  void add_all(const TurningState& state, const std::vector<TouchNow>& touches,
               const std::vector<Vector3>& force, std::span<Wrench> wrenches) const {
    std::size_t next = 0;
    for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
      if (group_.inertia[i].mass > 0.0) {
        add_to(i, state, touches, force, wrenches[next++]);
      }
    }
  }
  static void add_to(std::size_t i, const TurningState& state, const std::vector<TouchNow>& touches,
                     const std::vector<Vector3>& force, Wrench& wrench) {
    for (std::size_t k = 0; k < state.touches.size(); ++k) {
      const Touch& touch = state.touches[k];
      const TouchNow& now = touches[k];
      for (const auto& [place, point, sign] :
           {std::tuple{touch.a, now.point_a, -1.0}, {touch.b, now.point_b, 1.0}}) {
        if (place == i) {
          const Vector3 f = sign * force[k];
          wrench.force += f;
          wrench.torque += (point - state.states[i].pose.position).cross(f);
        }
      }
    }
  }

  const TurningGroup& group_;
  const TurningMode& mode_;
  double slow_;
};

/// A force on one body, as one of the group's.
class PlacedForce final : public Force {
 public:
  PlacedForce(const Force& force, std::size_t place) : force_(force), place_(place) {}

  void add(Instant t, std::span<const BodyState> bodies,
           std::span<Wrench> wrenches) const override {
    force_.add(t, bodies.subspan(place_, 1), wrenches.subspan(place_, 1));
  }
  [[nodiscard]] double potential(Instant t, std::span<const BodyState> bodies) const override {
    return force_.potential(t, bodies.subspan(place_, 1));
  }
  [[nodiscard]] bool conservative() const override { return force_.conservative(); }
  [[nodiscard]] bool involves_rotation() const override { return force_.involves_rotation(); }
  [[nodiscard]] std::string description() const override { return force_.description(); }

 private:
  const Force& force_;
  std::size_t place_;
};

/// Forces on what joints hold together, or those of the joints.
class MechanismForce final : public Force {
 public:
  /// `place`: of a body of the group in the island.
  MechanismForce(const GroupMechanism& mechanism, std::vector<std::size_t> place, bool of_joints)
      : mechanism_(mechanism), place_(std::move(place)), of_joints_(of_joints) {}

  void add(Instant t, std::span<const BodyState> bodies,
           std::span<Wrench> wrenches) const override {
    add_mechanism_forces(mechanism_, place_, of_joints_, t, bodies, wrenches);
  }
  [[nodiscard]] double potential(Instant, std::span<const BodyState>) const override { return 0.0; }
  [[nodiscard]] bool conservative() const override { return false; }
  [[nodiscard]] std::string description() const override { return "what acts on a mechanism"; }

 private:
  const GroupMechanism& mechanism_;
  std::vector<std::size_t> place_;
  bool of_joints_;
};

class Step {
 public:
  Step(const TurningGroup& group, const TurningMode& mode, Stepper& stepper, Instant t)
      : group_(group), mode_(mode), stepper_(stepper), t_(t), slow_(slow_slip(group)) {
    for (std::size_t i = 0; i < group.bodies.size(); ++i) {
      if (group.inertia[i].mass > 0.0) {
        free_.push_back(i);
        before_.push_back({group.start.states[i].pose, mode.velocities[i]});
      }
    }
  }

  TurningStep run(double longest) {
    if (!integrate(longest)) {
      return std::move(step_);
    }
    if (!mode_.implicit) {
      cut_at_strikes(raw_, strike_gap);
    } else {
      reach();
    }
    end_mode();
    finish();
    return std::move(step_);
  }

 private:
  /// Ends the step where a pair strikes on these motions, by free body; whether one does. `least`:
  /// of what strikes.
  bool cut_at_strikes(const std::vector<Motion>& motions, double least) {
    bool strikes = false;
    for (std::size_t p = 0; p < group_.pairs.size(); ++p) {
      const double until = strike_time(p, motions, least, step_.duration);
      if (until < step_.duration) {
        step_.duration = until;
        step_.end = TurningEnd::strike;
        step_.pair = group_.pairs[p].of;
        strikes = true;
      }
    }
    for (const Unwatched& far : group_.unwatched) {
      stay_away(far, motions);
    }
    return strikes;
  }

  /// Ends the step before pieces that nothing watches could have met.
  void stay_away(const Unwatched& far, const std::vector<Motion>& motions) {
    const double speeds = speeds_of(far.a, far.b, motions);
    if (speeds * step_.duration > far.distance) {
      step_.duration = far.distance / speeds;
      step_.end = TurningEnd::step;
    }
  }

  /// Bounds how fast points of both come nearer to each other in the step, m/s.
  [[nodiscard]] double speeds_of(std::size_t a, std::size_t b,
                                 const std::vector<Motion>& motions) const {
    double speeds = 0.0;
    for (const std::size_t i : {a, b}) {
      const Motion motion = motion_of(i, motions);
      speeds += motion.speed_bound(0.0, step_.duration) +
                group_.start.radius[i] * motion.angular_speed_bound(0.0, step_.duration);
    }
    return speeds;
  }

  /// What the velocities of an implicit step have come to, which was to be what it was sought for.
  void reach() {
    const std::vector<TouchNow> there = touches_of(touching_at(step_.stepped));
    for (std::size_t k = 0; k < there.size(); ++k) {
      const Touch& touch = group_.start.touches[k];
      const Vector3 before =
          look_at(touch, group_.start.states[touch.a], group_.start.states[touch.b]).normal;
      step_.reached.push_back(Quaternion::FromTwoVectors(there[k].normal, before) *
                              (there[k].velocity + touch.belt));
    }
  }

  [[nodiscard]] std::vector<BodyState> free_states(double s) const {
    std::vector<BodyState> states;
    for (const Motion& motion : raw_) {
      states.push_back({motion.pose(s), motion.twist(s)});
    }
    return states;
  }

  /// The group on its way, s after the start of the step.
  [[nodiscard]] TurningState at(double s) const {
    return turning_state(group_, t_ + s, free_states(s));
  }
  [[nodiscard]] TurningState touching_at(double s) const {
    return touching_state(group_, t_ + s, free_states(s));
  }

  bool integrate(double longest) {
    Island island;
    std::deque<PlacedForce> applied;
    const ContactForce force(group_, mode_);
    for (const std::size_t i : free_) {
      for (const Force* const of_one : group_.forces[i]) {
        island.forces.push_back(&applied.emplace_back(*of_one, island.bodies.size()));
      }
      island.bodies.push_back(group_.bodies[i]);
      island.inertia.push_back(group_.inertia[i]);
      island.constant_force.push_back(group_.constant_force[i]);
    }
    std::vector<std::size_t> place(group_.bodies.size(), 0);
    for (std::size_t k = 0; k < free_.size(); ++k) {
      place[free_[k]] = k;
    }
    std::deque<MechanismForce> hanging;
    for (const GroupMechanism& mechanism : group_.mechanisms) {
      island.forces.push_back(&hanging.emplace_back(mechanism, place, false));
    }
    island.forces.push_back(&force);
    for (const GroupMechanism& mechanism : group_.mechanisms) {
      island.forces.push_back(&hanging.emplace_back(mechanism, place, true));
    }
    const std::int64_t evaluated = stepper_.evaluations();
    double h = longest;
    for (int round = 0; round < most_halvings; ++round) {
      std::vector<BodyState> states = before_;
      stepper_.start(island, t_, states);
      const StepResult result = stepper_.step(island, t_, h, states);
      step_.evaluations = stepper_.evaluations() - evaluated;
      if (!result.ok || !(result.advanced > 0.0)) {
        step_.refusal = "integrator: " + std::string(result.reason);
        return false;
      }
      raw_.assign(free_.size(), {});
      stepper_.dense_output(raw_);
      step_.duration = result.advanced;
      step_.stepped = result.advanced;
      step_.halved = step_.halved || result.advanced < h;
      if (mode_.implicit || keeps_gaps()) {
        return true;
      }
      h = 0.5 * result.advanced;
      step_.halved = true;
    }
    step_.refusal = "no step is short enough to keep what touches in touch";
    return false;
  }

  [[nodiscard]] bool keeps_gaps() const {
    for (int j = 1; j <= samples; ++j) {
      const TurningState state = touching_at(step_.duration * j / samples);
      for (std::size_t k = 0; k < state.touches.size(); ++k) {
        const Touch& touch = state.touches[k];
        const double gap = look_at(touch, state.states[touch.a], state.states[touch.b]).gap;
        if (mode_.choices[k].does != Does::opens &&
            !(std::abs(gap - touch.gap) <= drift * group_.pairs[touch.watched].nearest)) {
          return false;
        }
      }
    }
    return true;
  }

  [[nodiscard]] double strike_time(std::size_t p, const std::vector<Motion>& motions, double least,
                                   double duration) const {
    const TurningPair& pair = group_.pairs[p];
    if (pair.apart_by > pair.nearest &&
        pair.apart_by - pair.nearest > speeds_of(pair.a, pair.b, motions) * step_.duration) {
      return duration;
    }
    SeparationWatch watch{pair, motion_of(pair.a, motions), motion_of(pair.b, motions), {}, {},
                          least};
    std::vector<Touch> open;
    for (std::size_t k = 0; k < group_.start.touches.size(); ++k) {
      const Touch& touch = group_.start.touches[k];
      if (touch.watched == p) {
        (mode_.choices[k].does != Does::opens ? watch.held : open).push_back(touch);
      }
    }
    for (const Touch& touch : group_.shared) {
      if (touch.watched == p && is_held(touch)) {
        watch.held.push_back(touch);
      }
    }
    if (watch.held.empty() && pair.planes_a.empty() && pair.planes_b.empty() && !pair.of_pieces) {
      if (!mode_.keeps_all) {
        return duration;  // it is met by the detector as any other
      }
      watch.open = std::move(open);
    }
    return watch.strike_time(duration);
  }

  /// Whether the touch that this one is, seen from a piece beside, is held.
  [[nodiscard]] bool is_held(const Touch& shared) const {
    for (std::size_t k = 0; k < group_.start.touches.size(); ++k) {
      const Touch& touch = group_.start.touches[k];
      if (touch.pair == shared.pair && touch.point == shared.point) {
        return mode_.choices[k].does != Does::opens;
      }
    }
    return false;
  }

  [[nodiscard]] Motion motion_of(std::size_t i, const std::vector<Motion>& motions) const {
    for (std::size_t k = 0; k < free_.size(); ++k) {
      if (free_[k] == i) {
        return motions[k];
      }
    }
    for (const GroupDriver& driver : group_.drivers) {
      if (driver.place == i) {
        return driver.motion.shifted(t_ - driver.motion.start);
      }
    }
    return Motion::at_rest(t_, group_.start.states[i].pose);
  }

  // --- What ends the mode -----------------------------------------------------------------------

  /// What the mode is at its end for at s; `step`: it is not.
  [[nodiscard]] TurningEnd ends_at(double s) {
    if (mode_.implicit) {
      return rim(touching_at(s)) ? TurningEnd::rim : TurningEnd::step;
    }
    const TurningState state = at(s);
    TurningForces forces(state);
    for (std::size_t k = 0; k < state.touches.size(); ++k) {
      if (stops(mode_.choices[k], forces.now()[k])) {
        return TurningEnd::forces;
      }
    }
    const auto found = forces.verified(directed(mode_, forces.now(), slow_), {.carry = &carry_});
    double beyond = 0.0;
    // What opens may close again: that is a strike, watched by its gap.
    for (std::size_t k = 0; k < state.touches.size(); ++k) {
      const double closing = -forces.gap_acceleration(k, found.accelerations) / forces.load();
      if (mode_.choices[k].does == Does::opens && closing >= found.violation) {
        return rim(state) ? TurningEnd::rim : TurningEnd::step;
      }
    }
    beyond = found.violation;
    if (beyond > guard) {
      return TurningEnd::forces;
    }
    return rim(state) ? TurningEnd::rim : TurningEnd::step;
  }

  /// Whether what slides, slides back.
  [[nodiscard]] bool stops(const FrictionChoice& c, const TouchNow& now) const {
    return (c.does == Does::slides || c.does == Does::begins) && !c.direction.isZero(0.0) &&
           c.direction.dot(now.velocity) < -reversed * slow_;
  }

  /// Whether something is held beyond the rim of what it is on: by more than roundoff, so that it
  /// is known to be beyond, and by more than twice what it was, as steps that end there may not
  /// follow each other without end.
  [[nodiscard]] bool rim(const TurningState& state) const {
    for (std::size_t k = 0; k < state.touches.size(); ++k) {
      const Touch& touch = state.touches[k];
      if (mode_.choices[k].does == Does::opens) {
        continue;
      }
      const double size = group_.start.radius[touch.a] + group_.start.radius[touch.b];
      for (const TouchRim& rim : group_.rims[k]) {
        const auto& start = group_.start.states;
        const double before = rim.beyond(touch, start[touch.a], start[touch.b]);
        if (rim.beyond(touch, state.states[touch.a], state.states[touch.b]) >
            2.0 * std::max(before, 0.0) + over_rim * size) {
          return true;
        }
      }
    }
    return false;
  }

  void end_mode() {
    double lo = 0.0;
    for (int j = 1; j <= samples; ++j) {
      const double hi = step_.duration * j / samples;
      if (ends_at(hi) != TurningEnd::step) {
        return bisect(lo, hi);
      }
      lo = hi;
    }
  }

  void bisect(double lo, double hi) {
    for (int k = 0; k < bisections; ++k) {
      const double middle = 0.5 * (lo + hi);
      (ends_at(middle) != TurningEnd::step ? hi : lo) = middle;
    }
    step_.duration = hi;
    step_.end = ends_at(hi);
  }

  // --- What is told -----------------------------------------------------------------------------

  /// What is told is bent to the states at its end, and is watched as it is told: what is taken out
  /// there may bring corners nearer, the more the more bodies hang together.
  void finish() {
    step_.states = group_.start.states;
    step_.motions.assign(group_.bodies.size(), {});
    for (int round = 0; round < most_halvings && step_.duration > 0.0; ++round) {
      std::vector<Motion> bent = bend();
      if (!cut_at_strikes(bent, bent_gap)) {
        raw_ = std::move(bent);
        if (mode_.implicit && !keeps_gaps()) {
          step_.refusal = "no step is short enough to keep what touches in touch";
          return;
        }
        for (std::size_t k = 0; k < free_.size(); ++k) {
          step_.motions[free_[k]] = raw_[k];
        }
        return book();
      }
      if (round >= few_cuts) {
        step_.duration *= 0.5;
        step_.end = TurningEnd::step;
      }
    }
    step_.duration = 0.0;
  }

  /// The motions of free bodies, as they end where nothing is off; sets the states there.
  std::vector<Motion> bend() {
    const double h = step_.duration;
    std::vector<Motion> bent = raw_;
    TurningState end = touching_at(h);
    std::vector<char> held;
    for (const FrictionChoice& c : mode_.choices) {
      held.push_back(c.does != Does::opens ? 1 : 0);
    }
    if (group_.mechanisms.empty()) {
      put_at_gaps(end, held);
    } else {
      put_onto_joints(end, held);
    }
    step_.states = end.states;
    const std::vector<TouchNow> there = touches_of(end);
    step_.choices = at_end(there);
    const std::vector<Twist> velocities = held_velocities(end, there, step_.choices).of;
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const std::size_t i = free_[k];
      BodyState& state = step_.states[i];
      state.pose = end.states[i].pose;
      state.twist = velocities[i];
      bent[k].duration = h;
      bend_to(bent[k], h, before_[k], state);
    }
    return bent;
  }

  /// What touches do at the end of the step. What is to stick at the end of an implicit step still
  /// slides where the step was cut short: it is not stopped by an impulse.
  [[nodiscard]] std::vector<FrictionChoice> at_end(const std::vector<TouchNow>& now) const {
    std::vector<FrictionChoice> choices = mode_.choices;
    if (!mode_.implicit || !(step_.duration < step_.stepped)) {
      return choices;
    }
    const double least = still_slides * TurningForces(group_.start).load() * step_.duration;
    for (std::size_t k = 0; k < choices.size(); ++k) {
      const Vector3 v = now[k].velocity + group_.start.touches[k].belt;
      const Vector3 u = v - now[k].normal * now[k].normal.dot(v);
      if (choices[k].does == Does::sticks && u.norm() > least) {
        choices[k].does = Does::slides;
      }
    }
    return choices;
  }

  /// The same of what hangs on joints: what is done for gaps is off the joints only as much as its
  /// square, and is put back onto them.
  void put_onto_joints(TurningState& end, const std::vector<char>& held) {
    const Instant t = t_ + step_.duration;
    bool fits = put_positions_onto_joints(group_.mechanisms, t, end.states);
    renew(end);
    put_at_gaps(end, held);
    fits = put_positions_onto_joints(group_.mechanisms, t, end.states) && fits;
    (void)put_velocities_onto_joints(group_.mechanisms, t, end.states);
    renew(end);
    if (!fits) {
      step_.refusal = "the joints fit no position at the end of a step";
    }
  }

  /// What follows from where bodies are.
  void renew(TurningState& state) const {
    for (std::size_t i = 0; i < state.bodies.size(); ++i) {
      state.bodies[i] = group_body(group_.inertia[i], state.states[i].pose);
    }
    state.joints = group_joints(group_.mechanisms, t_ + step_.duration, state.states);
  }

  /// Power of the contact forces at 8 nodes, and the polynomials through it, integrated.
  void book() {
    constexpr int nodes = PowerNodes::count;
    Eigen::MatrixXd of_body =
        Eigen::MatrixXd::Zero(nodes, static_cast<Eigen::Index>(group_.bodies.size()));
    Eigen::MatrixXd leaks = of_body;
    Eigen::MatrixXd of_driver = of_body;
    Eigen::MatrixXd of_pair = Eigen::MatrixXd::Zero(nodes, body_pairs());
    Eigen::MatrixXd of_belt = of_pair;
    Eigen::MatrixXd of_surface = of_pair;
    for (int j = 0; j < nodes; ++j) {
      power_at(PowerNodes::at(j) * step_.duration, of_body.row(j), of_pair.row(j), of_belt.row(j),
               of_surface.row(j), leaks.row(j), of_driver.row(j));
    }
    const auto integrated = [&](const Eigen::VectorXd& powers) {
      return PowerNodes::work(powers, step_.duration);
    };
    for (Eigen::Index i = 0; i < of_body.cols(); ++i) {
      step_.worked.push_back(integrated(of_body.col(i)));
    }
    for (Eigen::Index p = 0; p < of_pair.cols(); ++p) {
      step_.rubbed.push_back(integrated(of_pair.col(p)));
      for (const auto& [powers_of, axis] : {std::pair{&of_belt, 1}, {&of_surface, 2}}) {
        if (!powers_of->col(p).isZero(0.0)) {
          const Polynomial<3> work = integrated(powers_of->col(p));
          for (int k = 0; k <= work.degree(); ++k) {
            step_.rubbed.back()[k][axis] = work[k].x();
          }
        }
      }
    }
    for (Eigen::Index i = 0; i < of_body.cols(); ++i) {
      step_.leaked.push_back(integrated(leaks.col(i)));
      step_.driven.push_back(of_driver.col(i).isZero(0.0) ? Polynomial<3>()
                                                          : integrated(of_driver.col(i)));
    }
    if (free_.size() == 1) {
      leak_of_one();
    }
  }

  /// How many pairs of bodies touch.
  [[nodiscard]] Eigen::Index body_pairs() const {
    std::size_t count = 0;
    for (const TurningPair& pair : group_.pairs) {
      count = std::max(count, pair.of + 1);
    }
    return static_cast<Eigen::Index>(count);
  }

  /// Of one free body: the difference of what is told, so that it closes the ledger to the last
  /// bit.
  void leak_of_one() {
    Polynomial<3>& leaked = step_.leaked[free_[0]];
    leaked = step_.worked[free_[0]];
    for (const auto& work : step_.rubbed) {
      for (int k = 0; k <= work.degree(); ++k) {
        leaked[k].x() -= work[k].sum();
      }
    }
  }

  template <typename Bodies, typename Pairs>
  void power_at(double s, Bodies of_body, Pairs of_pair, Pairs of_belt, Pairs of_surface,
                Bodies leaks, Bodies of_driver) {
    const TurningState state = mode_.implicit ? touching_at(s) : at(s);
    const std::vector<TouchNow> touches = touches_of(state);
    const auto choices = directed(mode_, touches, slow_);
    // Of forces that are redundant those inside their cones rub.
    const std::vector<Vector3> force =
        mode_.implicit ? carried_forces(group_, mode_, touches)
                       : TurningForces(state).verified(choices, {.carry = &carry_}).force;
    for (std::size_t k = 0; k < state.touches.size(); ++k) {
      const Touch& touch = state.touches[k];
      const TouchNow& now = touches[k];
      const auto power = [&](std::size_t i, const Vector3& point) {
        const BodyState& at = state.states[i];
        return force[k].dot(at.twist.at(point, at.pose.position));
      };
      const double on_a = -power(touch.a, now.point_a);
      const double on_b = power(touch.b, now.point_b);
      for (const auto& [i, on] : {std::pair{touch.a, on_a}, {touch.b, on_b}}) {
        if (!(group_.inertia[i].mass > 0.0)) {
          of_surface[static_cast<Eigen::Index>(touch.pair)] -= on;
        }
      }
      of_body[static_cast<Eigen::Index>(touch.a)] += on_a;
      of_body[static_cast<Eigen::Index>(touch.b)] += on_b;
      double rubbed = 0.0;
      double carried = 0.0;
      if (!touch.belt.isZero(0.0)) {
        const Vector3 along = force[k] - now.normal * now.normal.dot(force[k]);
        carried = -along.dot(touch.belt);
        of_belt[static_cast<Eigen::Index>(touch.pair)] += carried;
      }
      const bool slides = choices[k].does == Does::slides || choices[k].does == Does::begins;
      // What sticks at the end of an implicit step may have slid in it.
      const bool may_slide = mode_.implicit && choices[k].does != Does::opens;
      if (may_slide || (slides && !choices[k].direction.isZero(0.0))) {
        const Vector3 along = force[k] - now.normal * now.normal.dot(force[k]);
        rubbed = std::min(along.dot(now.velocity), 0.0);
      }
      of_pair[static_cast<Eigen::Index>(touch.pair)] += rubbed;
      const std::size_t first = group_.inertia[touch.a].mass > 0.0 ? touch.a : touch.b;
      leaks[static_cast<Eigen::Index>(first)] += on_a + on_b - (rubbed + carried);
    }
    const auto joints = mode_.implicit && drives_joints()
                            ? group_joints(group_.mechanisms, t_ + s, state.states)
                            : state.joints;
    if (joints != nullptr && joints->driven()) {
      const Eigen::VectorXd power = joints->driven_work(given(state, touches, force));
      for (Eigen::Index m = 0; m < power.size(); ++m) {
        of_driver[static_cast<Eigen::Index>(joints->first_of(static_cast<std::size_t>(m)))] +=
            power[m];
      }
    }
  }

  [[nodiscard]] bool drives_joints() const {
    return std::any_of(
        group_.mechanisms.begin(), group_.mechanisms.end(),
        [](const GroupMechanism& m) { return m.joints != nullptr && m.joints->driven(); });
  }

  /// What contact forces give to the bodies, six numbers for each, as if there were no joints.
  static Eigen::VectorXd given(const TurningState& state, const std::vector<TouchNow>& touches,
                               const std::vector<Vector3>& force) {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * state.bodies.size()));
    for (std::size_t k = 0; k < state.touches.size(); ++k) {
      const Touch& touch = state.touches[k];
      const TouchNow& now = touches[k];
      for (const auto& [i, point, sign] :
           {std::tuple{touch.a, now.point_a, -1.0}, {touch.b, now.point_b, 1.0}}) {
        const GroupBody& body = state.bodies[i];
        const Vector3 on = sign * force[k];
        const auto at = static_cast<Eigen::Index>(6 * i);
        out.segment<3>(at) += body.inverse_mass * on;
        out.segment<3>(at + 3) += body.inverse_inertia * (point - body.position).cross(on);
      }
    }
    return out;
  }

  const TurningGroup& group_;
  const TurningMode& mode_;
  Stepper& stepper_;
  Instant t_;
  double slow_;
  std::vector<std::size_t> free_;
  std::vector<BodyState> before_;
  std::vector<Motion> raw_;         ///< by free body
  std::vector<std::size_t> carry_;  ///< which rays of cones carried the load when asked last
  TurningStep step_;
};

}  // namespace

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

double turning_rest(const TurningGroup& group) { return 4.0 * reversed * slow_slip(group); }

TurningStep turning_step(const TurningGroup& group, const TurningMode& mode, Stepper& stepper,
                         Instant t, double longest) {
  return Step(group, mode, stepper, t).run(longest);
}

}  // namespace core
}  // namespace kairos
