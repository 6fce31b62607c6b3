#include "core/schemes/frame/frame_motions.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace kairos {
inline namespace core {

FrameMotions::FrameMotions(FrameRun& run, const Method& method)
    : run_(run), trackers_(run.model.size()), paths_(run.model.size()) {
  for (BodyIndex i = 0; i < run.model.size(); ++i) {
    if (run.model.mobility(i) == Mobility::driven) {
      driven_.push_back(i);
      settle(i, 0.0);
    } else if (run.model.mobility(i) == Mobility::fixed) {
      paths_[i].push_back(Motion::at_rest(run.time, run.bodies[i].pose));
    }
  }
  for (std::size_t k = 0; k < run.model.islands().size(); ++k) {
    Mover mover(run.model, method, k);
    mover.motions.resize(mover.states.size());
    mover.gather(run.bodies);
    mover.stepper->start(mover.island, run.time, mover.states);
    movers_.push_back(std::move(mover));
  }
  run_.account.open(run_.time, run_.bodies);
}

// --- Steps -------------------------------------------------------------------------------------

void FrameMotions::begin_step(Mover& mover, Instant t) {
  for (std::size_t k = 0; k < mover.island.bodies.size(); ++k) {
    const BodyIndex i = mover.island.bodies[k];
    const Vector3 force = run_.model.gravity_force(i) + run_.given_force[i];
    mover.jumped = mover.jumped || force != mover.island.constant_force[k];
    mover.island.constant_force[k] = force;
  }
  if (mover.jumped) {
    mover.stepper->restart(mover.island, t, mover.states);
    mover.jumped = false;
  }
}

bool FrameMotions::step(Mover& mover, double& done, double until) {
  assert(done < until);
  const StepResult result =
      mover.stepper->step(mover.island, run_.time + done, until - done, mover.states);
  ++run_.cost.steps;
  const double reached = done + result.advanced;
  mover.projection = result.projection;
  if (!result.ok || !(reached > done)) {
    run_.stop(result.ok ? "integrator: its steps are too short to get on"
                        : "integrator: " + std::string(result.reason));
    return false;
  }
  // Time that only rounding leaves over is no step of its own: a solver may never get through it.
  constexpr double roundoff = 4.0 * std::numeric_limits<double>::epsilon();
  done = until - reached > roundoff * until ? reached : until;
  mover.last_step = result.advanced;
  return true;
}

void FrameMotions::advance(double h) {
  assert(h >= 0.0);
  for (Mover& mover : movers_) {
    if (mover.carried) {
      continue;
    }
    mover.gather(run_.bodies);
    begin_step(mover, run_.time);
    const bool dense = run_.wants_motions || !mover.island.forces.empty();
    for (double done = 0.0; done < h;) {
      const Instant start = run_.time + done;
      if (!step(mover, done, h)) {
        break;
      }
      if (dense) {
        mover.stepper->dense_output(mover.motions);
      }
      gather<BodyState>(mover.island, run_.bodies, mover.before);
      book_step(mover, mover.before, mover.states, start, mover.last_step, true, mover.projection);
      for (std::size_t k = 0; k < mover.states.size(); ++k) {
        run_.bodies[mover.island.bodies[k]] = mover.states[k];
      }
    }
  }
  end_step(h);
}

void FrameMotions::end_step(double h) {
  run_.time = run_.time + h;
  run_.last_step = h;
  for (const BodyIndex i : driven_) {
    settle(i, h);
  }
}

/// Moves a driven body to its place. Collisions see the velocity that its entity estimates (13.8).
void FrameMotions::settle(BodyIndex i, double interval) {
  const Motion motion = run_.model.body(i).drive->motion(run_.time, run_.mean_frame);
  BodyState truth{motion.pose(0.0), motion.twist(0.0)};
  const Vector3 velocity = run_.model.entity(i).tracked_velocity(trackers_[i], truth, interval);
  run_.bodies[i] = truth;
  run_.bodies[i].twist.linear = velocity;
}

Motion FrameMotions::last_motion(BodyIndex i) const {
  switch (run_.model.mobility(i)) {
    case Mobility::fixed:
      return paths_[i].front();
    case Mobility::driven:
      return run_.model.body(i).drive->motion(run_.time - run_.last_step, run_.last_step);
    case Mobility::free:
      break;
  }
  const Mover& mover = movers_[run_.model.island_of(i)];
  std::vector<Motion> motions(mover.states.size());
  mover.stepper->dense_output(motions);
  for (std::size_t k = 0; k < motions.size(); ++k) {
    if (mover.island.bodies[k] == i) {
      return motions[k];
    }
  }
  return motions.front();
}

void FrameMotions::carry(BodyIndex i, const BodyState& state) {
  Mover& mover = mover_of(i);
  run_.account.carried(mover.island, run_.time, {&run_.bodies[i], 1}, {&state, 1});
  run_.bodies[i] = state;
  mover.jumped = true;
}

// --- Proposals ---------------------------------------------------------------------------------

void FrameMotions::propose(double h) {
  assert(h > 0.0);
  proposed_ = h;
  for (Mover& mover : movers_) {
    if (mover.carried) {
      continue;
    }
    mover.gather(run_.bodies);
    mover.booked = mover.states;
    mover.booked_until = 0.0;
    mover.bent_at = 0.0;
    mover.projections.clear();
    for (const BodyIndex i : mover.island.bodies) {
      paths_[i].clear();
    }
    fly(mover, 0.0, h);
  }
  for (const BodyIndex i : driven_) {
    paths_[i].clear();
    for (double done = 0.0; done < h; done += paths_[i].back().duration) {
      paths_[i].push_back(run_.model.body(i).drive->motion(run_.time + done, h - done));
    }
  }
  for (const auto& [hand, held] : run_.model.grips()) {
    if (mover_of(held).carried) {
      paths_[held] = paths_[hand];
    }
  }
}

/// Extends the paths of an island from `from` to `to` of the proposal.
void FrameMotions::fly(Mover& mover, double from, double to) {
  begin_step(mover, run_.time + from);
  for (double done = from; done < to;) {
    if (!step(mover, done, to)) {
      // The run is stopped. Until the scheme notices, bodies stay where they came to.
      for (const BodyIndex i : mover.island.bodies) {
        const Pose pose = paths_[i].empty() ? run_.bodies[i].pose
                                            : paths_[i].back().pose(paths_[i].back().duration);
        paths_[i].push_back(Motion::at_rest(run_.time + done, pose));
      }
      return;
    }
    mover.stepper->dense_output(mover.motions);
    mover.projections.emplace_back(done, mover.projection);
    for (std::size_t k = 0; k < mover.motions.size(); ++k) {
      assert(mover.motions[k].start <= run_.time + done);
      paths_[mover.island.bodies[k]].push_back(mover.motions[k]);
    }
  }
}

const Motion& FrameMotions::path_motion(BodyIndex i, double s) const {
  const std::vector<Motion>& path = paths_[i];
  // A stiff force makes many motions in one frame, too many to search one by one.
  const auto after = std::partition_point(path.begin() + 1, path.end(), [&](const Motion& motion) {
    return motion.start - run_.time <= s;
  });
  return *(after - 1);
}

BodyState FrameMotions::on_path(BodyIndex i, double s) const {
  if (paths_[i].empty()) {
    return run_.bodies[i];
  }
  const Motion& motion = path_motion(i, s);
  const double local = std::min((run_.time - motion.start) + s, motion.duration);
  return {motion.pose(local), motion.twist(local)};
}

double FrameMotions::common_stretch(BodyIndex a, BodyIndex b, double s, double until) const {
  const auto left = [&](BodyIndex i) { return path_motion(i, s).end() - (run_.time + s); };
  return std::min({left(a), left(b), until - s});
}

void FrameMotions::accept(double s) {
  assert(s >= 0.0 && s <= proposed_);
  const bool whole = s >= proposed_;
  for (Mover& mover : movers_) {
    if (mover.carried) {
      continue;
    }
    book_path(mover, s);
    for (std::size_t k = 0; k < mover.states.size(); ++k) {
      const BodyIndex i = mover.island.bodies[k];
      run_.bodies[i] = whole ? mover.states[k] : on_path(i, s);
    }
    mover.jumped = mover.jumped || !whole;
  }
  end_step(s);
}

void FrameMotions::cut(BodyIndex i, double s) {
  assert(s >= 0.0 && s <= proposed_);
  book_path(mover_of(i), s);
  for (const BodyIndex k : mover_of(i).island.bodies) {
    std::vector<Motion>& path = paths_[k];
    while (path.size() > 1 && path.back().start - run_.time >= s) {
      path.pop_back();
    }
    path.back().duration = std::min(path.back().duration, s - (path.back().start - run_.time));
  }
}

void FrameMotions::fly_on(BodyIndex i, double s, const State& meeting) {
  Mover& mover = mover_of(i);
  assert(mover.booked_until >= s);  // or the jump would be booked as work along the path
  mover.gather(meeting);
  mover.booked = mover.states;
  mover.booked_until = s;
  mover.bent_at = s;
  if (s < proposed_) {
    fly(mover, s, proposed_);
  }
}

// --- Ledger ------------------------------------------------------------------------------------

/// Books one stepper step, or a part of one: states are by place in the island.
void FrameMotions::book_step(Mover& mover, const std::vector<BodyState>& from,
                             const std::vector<BodyState>& to, Instant t, double h, bool replayable,
                             const JointProjection& projection) {
  if (run_.wants_motions) {
    for (std::size_t k = 0; k < to.size(); ++k) {
      run_.recorder.motion(mover.island.bodies[k], mover.motions[k]);
    }
  }
  const double roundoff =
      run_.options.roundoff && replayable ? roundoff_of(mover, from, to, h) : 0.0;
  const bool exact = mover.closed_form(run_.model);
  gather<Vector3>(mover.island, run_.given_force, given_);
  Leg leg{mover.island, from, to, given_, exact, roundoff};
  if (mover.island.joints != nullptr) {
    leg.contact_work = run_.account.projected(projection);
    leg.riding_work =
        run_.account.joint_work(mover.island, mover.motions, t, h) + projection.driven;
  }
  if (mover.island.forces.empty()) {
    run_.account.leg(leg);
  } else {
    run_.account.leg(leg, mover.motions, t, h);
  }
}

/// Roundoff of the stepper's last step, J; 0 if it cannot be replayed.
double FrameMotions::roundoff_of(Mover& mover, const std::vector<BodyState>& from,
                                 const std::vector<BodyState>& to, double h) {
  return mover.roundoff(h, from, [&](std::size_t k) -> const BodyState& { return to[k]; })
      .value_or(0.0);
}

/// The projection at the end of the motion that a leg of the proposal is on, if the leg lasts until
/// there (but for roundoff of its end).
JointProjection FrameMotions::projection_until(const Mover& mover, double from, double end) {
  for (const auto& [ends, projection] : mover.projections) {
    if (ends > from) {
      return end >= ends * (1.0 - 1e-12) ? projection : JointProjection{};
    }
  }
  return {};
}

/// Books an island along its path up to `until` of the proposal.
void FrameMotions::book_path(Mover& mover, double until) {
  const BodyIndex first = mover.island.bodies.front();
  std::vector<BodyState>& to = mover.reached;
  to.resize(mover.states.size());
  while (mover.booked_until < until) {
    const double from = mover.booked_until;
    double end = from + common_stretch(first, first, from, until);
    if (!(end > from)) {
      end = until;  // rounding left a gap between the last motion and `until`
    }
    assert(end > from && end <= until);
    const bool at_end = end >= proposed_;
    // Only the stepper's last step can be replayed, and only from where it began.
    const bool replayable = path_motion(first, from).start == paths_[first].back().start &&
                            paths_[first].back().start == run_.time + from;
    for (std::size_t k = 0; k < to.size(); ++k) {
      const BodyIndex i = mover.island.bodies[k];
      mover.motions[k] = path_motion(i, from);
      mover.motions[k].duration =
          std::min(mover.motions[k].duration, end - (mover.motions[k].start - run_.time));
      to[k] = at_end ? mover.states[k] : on_path(i, end);
    }
    book_step(mover, mover.booked, to, run_.time + from, end - from, replayable,
              projection_until(mover, from, end));
    mover.booked = to;
    mover.booked_until = end;
  }
}

// --- What is told ------------------------------------------------------------------------------

void FrameMotions::check_finite() {
  for (const Mover& mover : movers_) {
    for (const BodyIndex i : mover.island.bodies) {
      const BodyState& s = run_.bodies[i];
      if (!std::isfinite(s.pose.position.sum() + s.twist.linear.sum() + s.twist.angular.sum())) {
        return run_.stop("not finite: the state of '" + run_.model.body(i).name + "' overflowed");
      }
    }
  }
}

std::int64_t FrameMotions::evaluations() const {
  std::int64_t sum = 0;
  for (const Mover& mover : movers_) {
    sum += mover.stepper->evaluations();
  }
  return sum;
}

static void persist(Archive& archive, TrackerMemory& memory) {
  archive(memory.primed, memory.accepted_position, memory.velocity);
}

void FrameMotions::Mover::persist(Archive& archive) {
  archive(island.constant_force, jumped, carried, states, last_step);
  stepper->persist(archive);
}

void FrameMotions::persist(Archive& archive) {
  archive(trackers_);
  for (Mover& mover : movers_) {
    archive(mover);
  }
}

}  // namespace core
}  // namespace kairos
