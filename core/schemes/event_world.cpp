#include "core/schemes/event_world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

// Motions, frames and the ledger; predictions and impacts are in files of their own.

namespace kairos {
inline namespace core {

EventWorld::EventWorld(const Model& model, const Method& method, const SchemeOptions& options,
                       Recorder& recorder)
    : model_(model),
      detector_(*method.detector),
      law_(*method.law),
      options_(options),
      recorder_(recorder),
      wants_motions_(recorder.wants_motions()),
      by_rank_(model.size()),
      rank_(model.size()),
      actors_(model.size()),
      now_(model.initial_state()),
      booked_(now_),
      drawn_(now_),
      field_forces_(model.size(), Vector3::Zero()),
      grasps_(model.grips().size(), Grasp::open),
      in_hand_(model.size(), 0),
      end_(Instant{} + options.duration),
      // Not shorter than some frames, so that epochs cost nothing.
      epoch_(std::max(model.scene().duration, 64.0 * mean_frame_duration(options.frames))),
      account_(model, ledger_) {
  for (BodyIndex i = 0; i < model.size(); ++i) {
    by_rank_[i] = i;
  }
  std::sort(by_rank_.begin(), by_rank_.end(),
            [&](BodyIndex a, BodyIndex b) { return model.body(a).name < model.body(b).name; });
  for (std::uint32_t r = 0; r < by_rank_.size(); ++r) {
    rank_[by_rank_[r]] = r;
  }
  for (const auto& [a, b] : model.pairs()) {
    actors_[a].partners.push_back(b);
    actors_[b].partners.push_back(a);
  }
  for (std::size_t k = 0; k < model.islands().size(); ++k) {
    Flow flow{.island = model.islands()[k], .stepper = method.stepper(model, k)};
    flow.exact = flow.stepper->info().order == 0;
    flow.states.resize(flow.island.bodies.size());
    flow.motions.resize(flow.island.bodies.size());
    flows_.push_back(std::move(flow));
  }
  if (model.broad_phase() != "all-pairs") {
    broad_phase_ = method.broad_phase(model.size());
    swept_bounds_ = method.swept_bounds;
  }
  recorder_.begin(model_);
  account_.open(time_, now_);
}

bool EventWorld::begin() {
  if (!options_.resume.empty()) {
    resume();
    return open_frame(time_);
  }
  epoch_end_ = Instant{} + epoch_;
  push(epoch_end_, Due::epoch_end, by_rank_.front(), by_rank_.front());
  for (const BodyIndex i : by_rank_) {
    switch (model_.mobility(i)) {
      case Mobility::fixed:
        actors_[i].motion = Motion::at_rest(time_, now_[i].pose);
        actors_[i].horizon = Instant::never();
        break;
      case Mobility::driven:
        drive(i, time_);
        break;
      case Mobility::free:
        break;
    }
  }
  for (const BodyIndex i : by_rank_) {
    if (model_.is_free(i) && flow_of(i).island.bodies.front() == i) {
      Flow& flow = flow_of(i);
      set_forces(flow);
      for (std::size_t k = 0; k < flow.states.size(); ++k) {
        flow.states[k] = now_[flow.island.bodies[k]];
      }
      flow.stepper->start(flow.island, time_, flow.states);
      next_segment(flow, time_);
    }
  }
  for (const auto& grip : model_.grips()) {
    follow_hand(grip.hand, time_);
  }
  predict_all(time_);
  return true;
}

/// Predictions were made up to here: makes those of the next epoch.
void EventWorld::next_epoch(Instant t) {
  epoch_end_ = t + epoch_;
  push(epoch_end_, Due::epoch_end, by_rank_.front(), by_rank_.front());
  for (const BodyIndex i : by_rank_) {
    // How long a ball is supported was looked at for one epoch only; where the surface moves, its
    // next motion tells.
    if (actors_[i].support && model_.mobility(actors_[i].support->surface) != Mobility::driven) {
      book(flow_of(i), t);
      now_[i] = state_at(i, t);
      launch(i, t);
    }
  }
  predict_all(t);
}

// --- Motions -----------------------------------------------------------------------------------

BodyState EventWorld::state_at(BodyIndex i, Instant t) const {
  const Motion& motion = actors_[i].motion;
  const double s = std::min(t - motion.start, motion.duration);
  return {motion.pose(s), motion.twist(s)};
}

Vector3 EventWorld::fields_at(BodyIndex i) const {
  Vector3 sum = Vector3::Zero();
  for (const BodyIndex field : actors_[i].fields) {
    sum += field_force(model_, field, now_[field], i);
  }
  return sum;
}

Vector3 EventWorld::net_force(BodyIndex i) const {
  return model_.gravity_force(i) + field_forces_[i];
}

Vector3 EventWorld::acting_force(BodyIndex i, Instant t, const BodyState& state,
                                 const Vector3& constant) const {
  Wrench wrench{constant, Vector3::Zero()};
  for (const Force* force : model_.islands()[model_.island_of(i)].forces) {
    force->add(t, {&state, 1}, {&wrench, 1});
  }
  return wrench.force;
}

void EventWorld::set_forces(Flow& flow) {
  flow.island.forces = model_.islands()[model_.island_of(flow.island.bodies.front())].forces;
  flow.support.reset();
  for (std::size_t k = 0; k < flow.island.bodies.size(); ++k) {
    const BodyIndex i = flow.island.bodies[k];
    field_forces_[i] = fields_at(i);
    Vector3 force = net_force(i);
    if (const auto& support = actors_[i].support) {
      force -= support->normal * support->normal.dot(force);
      if (!flow.island.forces.empty()) {
        flow.support = std::make_unique<SupportForce>(support->normal);
        flow.island.forces.push_back(flow.support.get());
      }
    }
    flow.island.constant_force[k] = force;
  }
}

/// The state of the island of i has jumped to what `now_` says of i: new motions from there.
void EventWorld::launch(BodyIndex i, Instant t) {
  Flow& flow = flow_of(i);
  set_forces(flow);
  for (std::size_t k = 0; k < flow.states.size(); ++k) {
    flow.states[k] = now_[flow.island.bodies[k]];
  }
  flow.stepper->restart(flow.island, t, flow.states);
  next_segment(flow, t);
}

void EventWorld::next_segment(Flow& flow, Instant t) {
  for (std::size_t k = 0; k < flow.states.size(); ++k) {
    booked_[flow.island.bodies[k]] = flow.states[k];
  }
  flow.booked = t;
  if (options_.roundoff) {
    flow.launched = flow.states;
    flow.roundoff = 0.0;
  }
  const double longest = options_.step > 0.0 ? options_.step : mean_frame_duration(options_.frames);
  // A closed form has no end of its own.
  const double h = flow.exact ? std::numeric_limits<double>::infinity() : std::min(epoch_, longest);
  ++cost_.steps;
  const StepResult step = flow.stepper->step(flow.island, t, h, flow.states);
  if (!step.ok || !(step.advanced > 0.0)) {
    stop(t, "integrator: " + std::string(step.reason));
    return;
  }
  flow.stepper->dense_output(flow.motions);
  for (std::size_t k = 0; k < flow.motions.size(); ++k) {
    set_motion(flow.island.bodies[k], flow.motions[k]);
  }
  hold(flow, t);
  const BodyIndex first = flow.island.bodies.front();
  if (std::isfinite(step.advanced)) {
    push(t + step.advanced, Due::segment_end, first, first);
  }
}

void EventWorld::set_motion(BodyIndex i, const Motion& motion) {
  actors_[i].motion = motion;
  actors_[i].horizon = motion.end();
  ++actors_[i].version;
  if (wants_motions_) {
    recorder_.motion(i, motion);
  }
}

/// A supported ball rides on its surface until its face ends or draws away.
void EventWorld::hold(Flow& flow, Instant t) {
  const BodyIndex i = flow.island.bodies.front();
  Actor& actor = actors_[i];
  if (!actor.support) {
    return;
  }
  const BodyIndex surface = actor.support->surface;
  const Motion under = actors_[surface].motion.shifted(t - actors_[surface].motion.start);
  const double left = std::min({epoch_end_ - t, under.duration, actor.motion.duration});
  double until =
      face_exit_time(model_.shape(surface), under, actor.motion, actor.support->normal, left);
  if (model_.mobility(surface) == Mobility::driven) {
    until = std::min(until, lift_off_time(under, actor.support->normal, flow.island.inertia[0].mass,
                                          net_force(i)));
    actor.motion = ride(actor.motion, under, actor.support->normal);
    actor.horizon = actor.motion.end();
    if (wants_motions_) {
      recorder_.motion(i, actor.motion);
    }
  }
  if (!model_.islands()[model_.island_of(i)].forces.empty()) {
    const Vector3& n = actor.support->normal;
    until = std::min(
        until, release_time(
                   [&](double s) {
                     const BodyState state{actor.motion.pose(s), actor.motion.twist(s)};
                     const Vector3 force = acting_force(i, t + s, state, net_force(i));
                     return n.dot(flow.island.inertia[0].mass * under.acceleration(s) - force);
                   },
                   std::min(until, left)));
  }
  if (t + until < epoch_end_) {
    push(t + until, Due::support_ends, i, surface);
  }
}

void EventWorld::drive(BodyIndex i, Instant t) {
  set_motion(i, model_.body(i).drive->motion(t, epoch_));
  now_[i] = state_at(i, t);
  push(actors_[i].motion.end(), Due::segment_end, i, i);
}

void EventWorld::segment_end(BodyIndex i, Instant t) {
  if (model_.mobility(i) == Mobility::driven) {
    drive(i, t);
    riders(i, t);
    follow_hand(i, t);
    predict(i, t);
    return;
  }
  Flow& flow = flow_of(i);
  book(flow, t);
  if (actors_[i].support) {
    now_[i] = state_at(i, t);  // where its surface took it, which the stepper does not know
    launch(i, t);
  } else {
    next_segment(flow, t);
  }
  for (const BodyIndex k : flow.island.bodies) {
    predict(k, t);
  }
}

// --- Ledger and frames -------------------------------------------------------------------------

void EventWorld::book(Flow& flow, Instant t) {
  const double duration = t - flow.booked;
  if (!(duration > 0.0)) {
    return;
  }
  const BodyIndex first = flow.island.bodies.front();
  if (flow.carried) {
    now_[first] = state_at(first, t);
    account_.carried(flow.island, t, booked_, now_);
    booked_[first] = now_[first];
    flow.booked = t;
    return;
  }
  // At its end a segment is where the stepper left it, which its motion tells up to roundoff.
  const bool whole = !(actors_[first].motion.end() - t > 0.0) && !actors_[first].support;
  for (std::size_t k = 0; k < flow.states.size(); ++k) {
    const BodyIndex i = flow.island.bodies[k];
    now_[i] = whole ? flow.states[k] : state_at(i, t);
  }
  double riding = 0.0;
  if (const auto& support = actors_[first].support;
      support && model_.mobility(support->surface) == Mobility::driven) {
    // The normal force m a_s.n - F.n, integrated over the surface's displacement along n; F what is
    // constant and what depends on the state.
    const Vector3& n = support->normal;
    const double v0 = n.dot(booked_[first].twist.linear);
    const double v1 = n.dot(now_[first].twist.linear);
    const double rise = n.dot(now_[first].pose.position - booked_[first].pose.position);
    riding = 0.5 * flow.island.inertia[0].mass * (v1 - v0) * (v1 + v0) -
             n.dot(net_force(first)) * rise +
             account_.bearing_work(model_.islands()[model_.island_of(first)].forces,
                                   actors_[first].motion, n, flow.booked, duration);
  }
  const Leg leg{flow.island,   booked_,    now_,
                field_forces_, flow.exact, options_.roundoff ? new_roundoff(flow, t) : 0.0,
                riding};
  if (flow.island.forces.empty()) {
    account_.leg(leg);
  } else {
    for (std::size_t k = 0; k < flow.motions.size(); ++k) {
      flow.motions[k] = actors_[flow.island.bodies[k]].motion;
    }
    account_.leg(leg, flow.motions, flow.booked, duration);
  }
  for (const BodyIndex i : flow.island.bodies) {
    booked_[i] = now_[i];
  }
  flow.booked = t;
}

/// Roundoff of the current segment since the ledger last looked, J.
double EventWorld::new_roundoff(Flow& flow, Instant t) {
  const BodyIndex first = flow.island.bodies.front();
  flow.replayed.resize(flow.launched.size());
  if (!flow.stepper->replay(flow.island, t - actors_[first].motion.start, flow.launched,
                            flow.replayed)) {
    return 0.0;
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < flow.replayed.size(); ++k) {
    sum += roundoff_energy(flow.island.inertia[k].mass, flow.island.constant_force[k],
                           now_[flow.island.bodies[k]], flow.replayed[k]);
  }
  return sum - std::exchange(flow.roundoff, sum);
}

bool EventWorld::draw() {
  const Instant t = next_frame_;
  time_ = t;
  for (Flow& flow : flows_) {
    book(flow, t);
  }
  for (BodyIndex i = 0; i < actors_.size(); ++i) {
    drawn_[i] = model_.mobility(i) == Mobility::fixed ? now_[i] : state_at(i, t);
  }
  account_.balance(t, drawn_);
  recorder_.stage(Stage::draw, 1.0);
  recorder_.frame({frame_index_, t, drawn_, ledger_, in_hand_});
  ++cost_.frames;
  return open_frame(t);
}

/// The frame that follows the one drawn at t; false where the run ends.
bool EventWorld::open_frame(Instant t) {
  const double left = end_ - t;
  const double frame = frame_duration(options_.frames, frame_index_);
  const bool over = left <= 1e-9 * frame;  // a remainder that only rounding left over
  if (whole_ && !stopped()) {
    offer_checkpoint(t, over || frame >= left);
  }
  ++frame_index_;
  if (over) {
    return false;
  }
  whole_ = whole_ && frame < left;
  next_frame_ = frame < left ? t + frame : end_;
  return true;
}

void EventWorld::stop(Instant t, std::string reason) {
  if (reason_.empty()) {
    reason_ = std::move(reason);
    next_frame_ = t;
    end_ = t;
  }
}

RunResult EventWorld::result() && {
  for (const Flow& flow : flows_) {
    cost_.right_hand_sides += flow.stepper->evaluations();
  }
  return {reason_.empty() ? RunStatus::completed : RunStatus::stopped,
          std::move(reason_),
          time_,
          std::move(drawn_),
          ledger_,
          cost_};
}

}  // namespace core
}  // namespace kairos
