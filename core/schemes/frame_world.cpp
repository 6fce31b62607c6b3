#include "core/schemes/frame_world.hpp"

#include "core/archive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kairos {
inline namespace core {

FrameWorld::FrameWorld(const Model& model, const Method& method, const SchemeOptions& options,
                       Recorder& recorder)
    : model_(model),
      detector_(*method.detector),
      law_(*method.law),
      law_needs_contact_(method.law->info().needs_contact),
      options_(options),
      recorder_(recorder),
      wants_motions_(recorder.wants_motions()),
      bodies_(model.initial_state()),
      after_(bodies_),
      given_force_(model.size(), Vector3::Zero()),
      trackers_(model.size()),
      grasps_(model),
      paths_(model.size()),
      account_(model, ledger_) {
  for (BodyIndex i = 0; i < model.size(); ++i) {
    movable_.push_back(model.mobility(i) != Mobility::fixed);
    if (model.mobility(i) == Mobility::driven) {
      driven_.push_back(i);
      settle(i, now_, 0.0);
    } else if (model.mobility(i) == Mobility::fixed) {
      paths_[i].push_back(Motion::at_rest(now_, bodies_[i].pose));
    }
  }
  for (std::size_t k = 0; k < model.islands().size(); ++k) {
    Mover mover{.island = model.islands()[k], .stepper = method.stepper(model, k)};
    mover.exact = mover.stepper->info().order == 0;
    mover.states.resize(mover.island.bodies.size());
    mover.motions.resize(mover.island.bodies.size());
    gather(mover);
    mover.stepper->start(mover.island, now_, mover.states);
    movers_.push_back(std::move(mover));
  }
  recorder_.begin(model_);
  account_.open(now_, bodies_);
  if (!options_.resume.empty()) {
    Archive archive(options_.resume);
    persist(archive);
    resumed_ = true;
  } else {
    follow_hands();
  }
}

bool FrameWorld::draw() {
  if (!resumed_) {
    check_finite();
    account_.balance(now_, bodies_);
    trace(Stage::draw, 1.0);
    recorder_.frame({frame_index_, now_, bodies_, ledger_, grasps_.in_hand()});
    ++cost_.frames;
  }
  const bool more = open_frame();
  resumed_ = false;
  return more;
}

/// The frame that follows what was drawn; false where the run ends.
bool FrameWorld::open_frame() {
  const double left = options_.duration - now_.seconds - now_.correction;
  frame_ = core::frame_duration(options_.frames, frame_index_);
  const bool over = left <= 1e-9 * frame_;  // a remainder that only rounding left over
  if (whole_ && !resumed_ && reason_.empty()) {
    offer_checkpoint(over || frame_ >= left);
  }
  if (!reason_.empty() || over) {
    return false;
  }
  whole_ = whole_ && frame_ < left;
  frame_ = std::min(frame_, left);
  ++frame_index_;
  return true;
}

void FrameWorld::stop(std::string reason) {
  if (reason_.empty()) {
    reason_ = std::move(reason);
  }
}

RunResult FrameWorld::result() && {
  for (const Mover& mover : movers_) {
    cost_.right_hand_sides += mover.stepper->evaluations();
  }
  return {reason_.empty() ? RunStatus::completed : RunStatus::stopped,
          std::move(reason_),
          now_,
          std::move(bodies_),
          ledger_,
          cost_};
}

void FrameWorld::gather(Mover& mover) const {
  for (std::size_t k = 0; k < mover.states.size(); ++k) {
    mover.states[k] = bodies_[mover.island.bodies[k]];
  }
}

void FrameWorld::scatter(const Mover& mover) {
  for (std::size_t k = 0; k < mover.states.size(); ++k) {
    bodies_[mover.island.bodies[k]] = mover.states[k];
  }
}

void FrameWorld::begin_step(Mover& mover, Instant t) {
  for (std::size_t k = 0; k < mover.island.bodies.size(); ++k) {
    const BodyIndex i = mover.island.bodies[k];
    const Vector3 force = model_.gravity_force(i) + given_force_[i];
    mover.jumped = mover.jumped || force != mover.island.constant_force[k];
    mover.island.constant_force[k] = force;
  }
  if (mover.jumped) {
    mover.stepper->restart(mover.island, t, mover.states);
    mover.jumped = false;
  }
}

bool FrameWorld::step(Mover& mover, double& done, double until) {
  const StepResult result =
      mover.stepper->step(mover.island, now_ + done, until - done, mover.states);
  ++cost_.steps;
  const double reached = done + result.advanced;
  if (!result.ok || !(reached > done)) {
    stop(result.ok ? "integrator: its steps are too short to get on"
                   : "integrator: " + std::string(result.reason));
    return false;
  }
  // What rounding leaves of the time is no step of its own: a solver may never get through it.
  constexpr double roundoff = 4.0 * std::numeric_limits<double>::epsilon();
  done = until - reached > roundoff * until ? reached : until;
  mover.last_step = result.advanced;
  return true;
}

void FrameWorld::advance(double h) {
  record_fields_left();
  for (Mover& mover : movers_) {
    if (mover.carried) {
      continue;
    }
    gather(mover);
    begin_step(mover, now_);
    const bool dense = wants_motions_ || !mover.island.forces.empty();
    for (double done = 0.0; done < h;) {
      const Instant start = now_ + done;
      if (!step(mover, done, h)) {
        break;
      }
      if (dense) {
        mover.stepper->dense_output(mover.motions);
      }
      book_step(mover, start, mover.last_step, true);
      scatter(mover);
    }
  }
  end_step(h);
}

void FrameWorld::end_step(double h) {
  now_ = now_ + h;
  last_step_ = h;
  for (const BodyIndex i : driven_) {
    settle(i, now_, h);
  }
  follow_hands();
  if (any_given_) {
    std::fill(given_force_.begin(), given_force_.end(), Vector3::Zero());
    any_given_ = false;
  }
}

/// A driven body takes its place; collisions see the velocity that its entity estimates (13.8).
void FrameWorld::settle(BodyIndex i, Instant t, double interval) {
  const Motion motion = model_.body(i).drive->motion(t, mean_frame_duration(options_.frames));
  BodyState truth{motion.pose(0.0), motion.twist(0.0)};
  const Vector3 velocity = model_.entity(i).tracked_velocity(trackers_[i], truth, interval);
  bodies_[i] = truth;
  bodies_[i].twist.linear = velocity;
}

/// Books one stepper step: `bodies_` is where it began, `mover.states` where it ended.
void FrameWorld::book_step(Mover& mover, Instant t, double h, bool replayable) {
  if (wants_motions_) {
    for (std::size_t k = 0; k < mover.motions.size(); ++k) {
      recorder_.motion(mover.island.bodies[k], mover.motions[k]);
    }
  }
  for (std::size_t k = 0; k < mover.states.size(); ++k) {
    after_[mover.island.bodies[k]] = mover.states[k];
  }
  const double roundoff = options_.roundoff && replayable ? replay(mover, h) : 0.0;
  const Leg leg{mover.island, bodies_, after_, given_force_, mover.exact, roundoff};
  if (mover.island.forces.empty()) {
    account_.leg(leg);
  } else {
    account_.leg(leg, mover.motions, t, h);
  }
}

/// Roundoff of the stepper's last step, which began at `bodies_`, J; 0 where it cannot be replayed.
double FrameWorld::replay(Mover& mover, double h) {
  const std::vector<BodyState> after = mover.states;
  gather(mover);
  mover.replayed.resize(after.size());
  double sum = 0.0;
  if (mover.stepper->replay(mover.island, h, mover.states, mover.replayed)) {
    for (std::size_t k = 0; k < after.size(); ++k) {
      sum += roundoff_energy(mover.island.inertia[k].mass, mover.island.constant_force[k], after[k],
                             mover.replayed[k]);
    }
  }
  mover.states = after;
  return sum;
}

void FrameWorld::check_finite() {
  for (const Mover& mover : movers_) {
    for (const BodyIndex i : mover.island.bodies) {
      const BodyState& s = bodies_[i];
      if (!std::isfinite(s.pose.position.sum() + s.twist.linear.sum() + s.twist.angular.sum())) {
        stop("not finite: the state of '" + model_.body(i).name + "' overflowed");
        return;
      }
    }
  }
}

int detect_and_handle(FrameWorld& world) {
  constexpr BodyIndex none = std::numeric_limits<BodyIndex>::max();
  BodyIndex last_next = none;
  int handled = 0;
  for (BodyIndex current = 0; current < world.size(); ++current) {
    for (BodyIndex next = current + 1; next < world.size(); ++next) {
      if (!world.movable(current) && !world.movable(next)) {
        continue;
      }
      if (world.overlap(current, next) && next != last_next) {
        last_next = next;
        world.handle(current, next);
        ++handled;
        break;
      }
    }
  }
  return handled;
}

void give_field_forces(FrameWorld& world) {
  for (const auto& [a, b] : world.model().pairs()) {
    if ((world.model().is_field(a) || world.model().is_field(b)) && world.overlap(a, b)) {
      world.handle(a, b);
    }
  }
}

}  // namespace core
}  // namespace kairos
