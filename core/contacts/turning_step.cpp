#include "core/contacts/turning_step.hpp"

#include "core/bent_motion.hpp"
#include "core/contacts/separation_watch.hpp"
#include "core/contacts/turning_books.hpp"
#include "core/contacts/turning_island.hpp"
#include "core/contacts/turning_way.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

using Does = FrictionChoice::Does;

/// A mode goes on until a force is beyond its cone by so many times what is accepted: what follows
/// is then no tie.
constexpr double guard = 4.0;
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
/// A rim that comes to lie flat is looked at again as much before: what is bent to the gaps turns
/// it by as much as a long step is off, of which a short one that ends where it is flat has
/// nothing.
constexpr double short_of_flat = 1e-8;

class Step {
 public:
  Step(const TurningGroup& group, const TurningMode& mode, Stepper& stepper, Instant t)
      : group_(group), mode_(mode), stepper_(stepper), t_(t), way_(group, mode, t) {
    for (const std::size_t i : way_.free) {
      before_.push_back({group.start.states[i].pose, mode.velocities[i]});
    }
  }

  TurningStep run(double longest) {
    if (!integrate(longest)) {
      return std::move(step_);
    }
    if (!mode_.implicit) {
      cut_at_strikes(way_.motions, strike_gap);
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
    const std::vector<TouchNow> there = touches_of(way_.touching_at(step_.stepped));
    for (std::size_t k = 0; k < there.size(); ++k) {
      const Touch& touch = group_.start.touches[k];
      const Vector3 before =
          look_at(touch, group_.start.states[touch.a], group_.start.states[touch.b]).normal;
      step_.reached.push_back(Quaternion::FromTwoVectors(there[k].normal, before) *
                              (there[k].velocity + touch.belt));
    }
  }

  bool integrate(double longest) {
    const TurningIsland integrated(way_);
    const Island& island = integrated.island();
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
      way_.motions.assign(way_.free.size(), {});
      stepper_.dense_output(way_.motions);
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
      const TurningState state = way_.touching_at(step_.duration * j / samples);
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
    for (std::size_t k = 0; k < way_.free.size(); ++k) {
      if (way_.free[k] == i) {
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
      return rim(way_.touching_at(s)) ? TurningEnd::rim : TurningEnd::step;
    }
    const TurningState state = way_.at(s);
    TurningForces forces(state);
    for (std::size_t k = 0; k < state.touches.size(); ++k) {
      if (stops(mode_.choices[k], forces.now()[k])) {
        return TurningEnd::forces;
      }
    }
    const auto found = forces.verified(directed(mode_, forces.now(), way_.slow),
                                       {.nearly = mode_.forces.nearly, .carry = &way_.carry});
    // What opens may close again: that is a strike, watched by its gap.
    for (std::size_t k = 0; k < state.touches.size(); ++k) {
      const double closing = -forces.gap_acceleration(k, found.accelerations) / forces.load();
      if (mode_.choices[k].does == Does::opens && closing >= found.violation) {
        return rim(state) ? TurningEnd::rim : TurningEnd::step;
      }
    }
    if (found.violation > guard * found.allowed()) {
      return TurningEnd::forces;
    }
    return rim(state) ? TurningEnd::rim : TurningEnd::step;
  }

  /// Whether what slides, slides back.
  [[nodiscard]] bool stops(const FrictionChoice& c, const TouchNow& now) const {
    return (c.does == Does::slides || c.does == Does::begins) && !c.direction.isZero(0.0) &&
           c.direction.dot(now.velocity) < -reversed * way_.slow;
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
        double most = 2.0 * std::max(before, 0.0) + over_rim * size;
        if (rim.of_normal) {
          most = before < -2.0 * short_of_flat * size ? -short_of_flat * size : over_rim * size;
        }
        if (rim.beyond(touch, state.states[touch.a], state.states[touch.b]) > most) {
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
        return ends_within() ? bisect(lo, hi) : void();
      }
      lo = hi;
    }
  }

  /// Whether what seems to be the end is: implicit motions are off their gaps, and may turn beyond
  /// a rim by that. Bent to them they end where they do.
  bool ends_within() {
    if (!mode_.implicit) {
      return true;
    }
    (void)bend();
    step_.refusal.clear();  // it is bent again where it ends
    TurningState end = way_.touching_at(step_.duration);
    end.states = step_.states;
    return rim(end);
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
        way_.motions = std::move(bent);
        if (mode_.implicit && !keeps_gaps()) {
          step_.refusal = "no step is short enough to keep what touches in touch";
          return;
        }
        for (std::size_t k = 0; k < way_.free.size(); ++k) {
          step_.motions[way_.free[k]] = way_.motions[k];
        }
        return book_turning_step(way_, step_);
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
    std::vector<Motion> bent = way_.motions;
    TurningState end = way_.touching_at(h);
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
    for (std::size_t k = 0; k < way_.free.size(); ++k) {
      const std::size_t i = way_.free[k];
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

  const TurningGroup& group_;
  const TurningMode& mode_;
  Stepper& stepper_;
  Instant t_;
  TurningWay way_;
  std::vector<BodyState> before_;
  TurningStep step_;
};

}  // namespace

double turning_rest(const TurningGroup& group) { return 4.0 * reversed * slow_slip(group); }

TurningStep turning_step(const TurningGroup& group, const TurningMode& mode, Stepper& stepper,
                         Instant t, double longest) {
  return Step(group, mode, stepper, t).run(longest);
}

}  // namespace core
}  // namespace kairos
