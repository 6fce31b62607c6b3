#include "core/schemes/event/event_motions.hpp"

#include "core/archive.hpp"
#include "core/joint_system.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace kairos {
inline namespace core {

namespace {

/// So few bodies keep their motions as they are, which is faster, in 25 MB.
constexpr std::size_t few = 16'384;

}  // namespace

EventMotions::EventMotions(EventRun& run, const Method& method)
    : run_(run),
      bodies_(run.model.size()),
      riders_(run.model.size(), 0),
      flights_(run.model.size()),
      flies_(run.model.size(), 0),
      now_(run.model.initial_state()),
#ifndef NDEBUG
      brought_(run.model.size(), run.time),
#endif
      booked_(now_),
      field_forces_(run.model.size(), Vector3::Zero()) {
  whole_.resize(run.model.size() <= few ? run.model.size() : 0);
  for (BallFlight& flight : flights_) {
    flight.radius = std::numeric_limits<double>::infinity();
  }
  for (std::size_t k = 0; k < run.model.islands().size(); ++k) {
    Flow flow(run.model, method, k);
    flow.exact = flow.stepper->info().order == 0;
    if (flow.states.size() > motions_.size()) {
      motions_.resize(flow.states.size());
    }
    flows_.push_back(std::move(flow));
  }
  run_.account.open(run_.time, now_);
}

void EventMotions::begin() {
  for (const BodyIndex i : run_.agenda.by_name()) {
    switch (run_.model.mobility(i)) {
      case Mobility::fixed:
        keep_motion(i, Motion::at_rest(run_.time, now_[i].pose));
        set_flight(i, of(i));
        break;
      case Mobility::driven:
        drive(i, run_.time);
        break;
      case Mobility::free:
        break;
    }
  }
  for (const BodyIndex i : run_.agenda.by_name()) {
    if (run_.model.is_free(i) && island(i).front() == i) {
      Flow& flow = flow_of(i);
      set_forces(flow);
      flow.gather(now_);
      flow.stepper->start(flow.island, run_.time, flow.states);
      next_segment(flow, run_.time);
    }
  }
}

BodyState EventMotions::at(BodyIndex i, Instant t) const {
  if (!whole_.empty()) {
    const Motion& motion = whole_[i];
    const double s = std::min(t - motion.start, motion.duration);
    return {motion.pose(s), motion.twist(s)};
  }
  const StoredMotion& motion = bodies_[i].motion;
  return motion.at(std::min(t - motion.start(), motion.duration()));
}

void EventMotions::bring_others(BodyIndex i, Instant t) {
  for (const BodyIndex k : island(i)) {
    if (k != i) {
      bring(k, t);
    }
  }
}

// --- Motions -----------------------------------------------------------------------------------

void EventMotions::open(BodyIndex i, Instant t) {
  book(i, t);
  for (const BodyIndex k : island(i)) {
    bring(k, t);
  }
}

void EventMotions::open_pair(BodyIndex a, BodyIndex b, Instant t) {
  for (const BodyIndex i : {a, b}) {
    if (run_.model.is_free(i)) {
      book(i, t);
    }
    if (run_.model.mobility(i) != Mobility::fixed) {
      bring(i, t);
    }
  }
}

/// What is forgotten before a launch would be a wrong ledger or a wrong motion, and no error.
void EventMotions::check_ready([[maybe_unused]] const Flow& flow,
                               [[maybe_unused]] Instant t) const {
  assert(!(flow.booked < t));
#ifndef NDEBUG
  for (const BodyIndex k : flow.island.bodies) {
    assert(brought_[k] == t);
  }
#endif
}

void EventMotions::launch(BodyIndex i, Instant t) {
  Flow& flow = flow_of(i);
  check_ready(flow, t);
  flow.held = false;
  for (const BodyIndex k : flow.island.bodies) {
    bodies_[k].rubs.clear();
    bodies_[k].turns = false;
    bodies_[k].worked.clear();
  }
  set_forces(flow);
  if (flow.island.joints != nullptr) {
    put_onto_joints(i, t);
  }
  flow.gather(now_);
  flow.stepper->restart(flow.island, t, flow.states);
  next_segment(flow, t);
}

void EventMotions::put_onto_joints(BodyIndex i, Instant t) {
  Flow& flow = flow_of(i);
  flow.gather(now_);
  const JointProjection projection = flow.island.joints->project_velocities(t, flow.states);
  run_.ledger.add(EnergyLine::projection, projection.velocity);
  run_.ledger.add(EnergyLine::driven_work, projection.driven);
  for (std::size_t k = 0; k < flow.states.size(); ++k) {
    BodyState& now = now_[flow.island.bodies[k]];
    run_.account.struck(flow.island.bodies[k], now, flow.states[k]);
    now = flow.states[k];
  }
}

void EventMotions::rest(BodyIndex i, Instant t) {
  Flow& flow = flow_of(i);
  check_ready(flow, t);
  flow.held = true;
  for (std::size_t k = 0; k < flow.states.size(); ++k) {
    const BodyIndex body = flow.island.bodies[k];
    flow.states[k] = booked_[body] = now_[body];
    set_motion(body, Motion::at_rest(t, now_[body].pose));
  }
  flow.booked = t;
  flow.projection = {};
}

void EventMotions::hold(BodyIndex i, Instant t, const Motion& motion) {
  hold(i, t, Twist{motion.acceleration(0.0), Vector3::Zero()});
  set_motion(i, motion);
}

void EventMotions::turn(BodyIndex i, Instant t, const Turn& turn) {
  hold(i, t, Twist{});
  MovingBody& body = bodies_[i];
  body.turns = true;
  body.worked.assign(1, turn.worked);
  Flow& flow = flow_of(i);
  flow.states[0] = turn.end;
  set_motion(i, turn.motion);
}

void EventMotions::hold(BodyIndex i, Instant t, const Twist& acceleration) {
  Flow& flow = flow_of(i);
  check_ready(flow, t);
  flow.held = true;
  set_support(i, std::nullopt);
  bodies_[i].rubs.clear();
  bodies_[i].turns = false;
  bodies_[i].worked.clear();
  set_forces(flow);
  flow.island.constant_force[0] = run_.model.inertia(i).mass * acceleration.linear;
  flow.states[0] = booked_[i] = now_[i];
  flow.booked = t;
  if (run_.options.roundoff) {
    flow.launched = flow.states;
    flow.lost = 0.0;
  }
  Motion motion = Motion::ballistic(t, std::numeric_limits<double>::infinity(), now_[i].pose,
                                    now_[i].twist, acceleration.linear);
  if (!acceleration.angular.isZero(0.0)) {
    // Of a sphere, which looks the same all around: its spin is followed, its orientation is not.
    motion.rotation = RotationKind::constant_rate;
    motion.angular_velocity = Polynomial<3>(now_[i].twist.angular, acceleration.angular);
  }
  set_motion(i, motion);
}

void EventMotions::rub(BodyIndex i, Instant t, Rub rub) {
  rub.from_a = at(rub.a, t);
  rub.from_b = at(rub.b, t);
  rub.booked = rub.begun = t;
  bodies_[i].rubs.push_back(rub);
}

void EventMotions::go_on(BodyIndex i, Instant t) {
  if (run_.model.mobility(i) == Mobility::driven) {
    return drive(i, t);
  }
  book(i, t);
  if (bodies_[i].support) {
    bring(i, t);  // where its surface took it, which the stepper does not know
    launch(i, t);
  } else {
    next_segment(flow_of(i), t);
  }
}

/// One stepper step, as motions.
void EventMotions::next_segment(Flow& flow, Instant t) {
  for (std::size_t k = 0; k < flow.states.size(); ++k) {
    booked_[flow.island.bodies[k]] = flow.states[k];
  }
  flow.booked = t;
  if (run_.options.roundoff) {
    flow.launched = flow.states;
    flow.lost = 0.0;
  }
  const double longest = run_.options.step > 0.0 ? run_.options.step : run_.mean_frame;
  // A closed form has no end of its own.
  const double h =
      flow.exact ? std::numeric_limits<double>::infinity() : std::min(run_.epoch(), longest);
  ++run_.cost.steps;
  const StepResult step = flow.stepper->step(flow.island, t, h, flow.states);
  if (!step.ok || !(step.advanced > 0.0)) {
    run_.stop(t, "integrator: " + std::string(step.reason));
    return;
  }
  flow.projection = step.projection;
  flow.exact = flow.stepper->info().order == 0;  // a closed form may have given up
  const std::span motions(motions_.data(), flow.states.size());
  for (Motion& motion : motions) {  // what not all steppers tell, and another has told
    motion.rotation_rate.setZero();
    motion.error_radius = 0.0;
  }
  flow.stepper->dense_output(motions);
  for (std::size_t k = 0; k < motions.size(); ++k) {
    set_motion(flow.island.bodies[k], motions[k]);
  }
  hold(flow, t);
  const BodyIndex first = flow.island.bodies.front();
  if (std::isfinite(step.advanced)) {
    run_.agenda.push(t + step.advanced, Due::segment_end, first, first);
  }
}

/// The next motion of a driven body.
void EventMotions::drive(BodyIndex i, Instant t) {
  set_motion(i, run_.model.body(i).drive->motion(t, run_.epoch()));
  bring(i, t);
  run_.agenda.push(end_of(i), Due::segment_end, i, i);
}

void EventMotions::keep_motion(BodyIndex i, const Motion& motion) {
  if (whole_.empty()) {
    bodies_[i].motion = motion;
  } else {
    whole_[i] = motion;
  }
}

void EventMotions::set_motion(BodyIndex i, const Motion& motion) {
  keep_motion(i, motion);
  set_flight(i, motion);
  run_.agenda.renew(i);
  if (run_.wants_motions) {
    tell_motion(i, motion);
  }
}

void EventMotions::tell_motion(BodyIndex i, const Motion& motion) {
  if (run_.boxes_on.empty() || is_zero(run_.boxes_on[i])) {
    return run_.recorder.motion(i, motion);
  }
  Motion told = motion;
  told.position[0] += run_.way_told(i);
  run_.recorder.motion(i, told);
}

void EventMotions::go_on_as(BodyIndex i, const Image& n) {
  const Vector3 shift = run_.model.scene().periodic->shift(n);
  Motion motion = of(i);
  motion.position[0] += shift;
  keep_motion(i, motion);
  set_flight(i, motion);
  now_[i].pose.position += shift;
  booked_[i].pose.position += shift;
  for (std::size_t k = 0; k < 3; ++k) {
    run_.boxes_on[i][k] -= n[k];
  }
}

void EventMotions::set_support(BodyIndex i, const std::optional<Support>& support) {
  if (const auto& before = bodies_[i].support) {
    --riders_[before->surface];
  }
  if (support) {
    ++riders_[support->surface];
  }
  bodies_[i].support = support;
}

void EventMotions::set_flight(BodyIndex i, const Motion& motion) {
  const Shape& shape = run_.model.shape(i);
  const bool parabola = motion.position.degree() <= 2;
  flies_[i] = static_cast<char>(parabola && std::holds_alternative<Sphere>(shape) &&
                                run_.model.is_free(i) && !bodies_[i].support &&
                                std::isinf(motion.duration));
  if (!parabola) {
    flights_[i].radius = std::numeric_limits<double>::infinity();
    return;
  }
  const auto coefficient = [&](int k) {
    return k <= motion.position.degree() ? Vector3(motion.position[k]) : Vector3(Vector3::Zero());
  };
  // What is no ball may touch by what a detector leaves and its bounding ball, rounded, does not.
  const double more = std::holds_alternative<Sphere>(shape) ? 1.0 : 1.0 + 0x1p-20;
  flights_[i] = {coefficient(0), coefficient(1), 2.0 * coefficient(2), motion.start,
                 more * bounding_radius(shape) + motion.error_radius};
}

/// A supported ball rides on its surface until its face ends or draws away.
void EventMotions::hold(Flow& flow, Instant t) {
  const BodyIndex i = flow.island.bodies.front();
  const std::optional<Support>& support = bodies_[i].support;
  if (!support) {
    return;
  }
  Motion motion = of(i);
  const Vector3& n = support->normal;
  const BodyIndex surface = support->surface;
  const double mass = flow.island.inertia[0].mass;
  const Motion under = of(surface).shifted(t - start_of(surface));
  const double left = std::min({run_.epoch_end() - t, under.duration, motion.duration});
  double until = face_exit_time(run_.model.shape(surface), under, motion, n, left);
  if (run_.model.mobility(surface) == Mobility::driven) {
    until = std::min(until, lift_off_time(under, n, mass, net_force(i)));
    motion = ride(motion, under, n);
    keep_motion(i, motion);
    if (run_.wants_motions) {
      tell_motion(i, motion);
    }
  }
  if (!run_.model.islands()[run_.model.island_of(i)].forces.empty()) {
    const auto contact_force = [&](double s) {
      const BodyState state{motion.pose(s), motion.twist(s)};
      return n.dot(mass * under.acceleration(s) - acting_force(i, t + s, state));
    };
    until = std::min(until, release_time(contact_force, std::min(until, left)));
  }
  run_.push_in_epoch(t + until, Due::support_ends, i, surface);
}

void EventMotions::carry(BodyIndex i, BodyIndex hand, const BodyState& state, Instant t) {
  Flow& flow = flow_of(i);
  now_[i] = state;
  mark_brought(i, t);
  run_.account.carried(flow.island, t, booked_, now_);
  booked_[i] = state;
  flow.booked = t;
  flow.carried = true;
  Motion motion = of(hand).shifted(t - start_of(hand));
  motion.rotation = RotationKind::fixed;
  motion.quaternion = Motion::at_rest(t, state.pose).quaternion;
  motion.angular_velocity = {};
  set_motion(i, motion);
}

// --- Forces ------------------------------------------------------------------------------------

bool EventMotions::is_in_field(BodyIndex i, BodyIndex field) const {
  const std::vector<BodyIndex>& fields = bodies_[i].fields;
  return std::find(fields.begin(), fields.end(), field) != fields.end();
}

Vector3 EventMotions::field_forces_at(BodyIndex i) const {
  Vector3 sum = Vector3::Zero();
  for (const BodyIndex field : bodies_[i].fields) {
    sum += field_force(run_.model, field, now_[field], i);
  }
  return sum;
}

/// What is constant over a segment, N.
Vector3 EventMotions::net_force(BodyIndex i) const {
  return run_.model.gravity_force(i) + field_forces_[i];
}

/// That and what depends on the state, of a body that is alone in its island, N.
Vector3 EventMotions::acting_force(BodyIndex i, Instant t, const BodyState& state) const {
  Wrench wrench{run_.model.gravity_force(i) + field_forces_at(i), Vector3::Zero()};
  for (const Force* force : run_.model.islands()[run_.model.island_of(i)].forces) {
    force->add(t, {&state, 1}, {&wrench, 1});
  }
  return wrench.force;
}

double EventMotions::pressing(BodyIndex ball, const Support& support, Instant t, bool held) const {
  const auto surface_acceleration = [&](BodyIndex surface) {
    const auto riding = moving(surface);
    const Motion& under = riding.motion();
    return under.acceleration(std::min(t - under.start, under.duration));
  };
  Vector3 own = acting_force(ball, t, now_[ball]) / run_.model.inertia(ball).mass;
  if (const std::optional<Support>& other = bodies_[ball].support; held && other) {
    own += other->normal * other->normal.dot(surface_acceleration(other->surface) - own);
  }
  return support.normal.dot(surface_acceleration(support.surface) - own);
}

bool EventMotions::is_damped(BodyIndex i) const {
  if (!run_.model.is_free(i)) {
    return false;
  }
  const auto& forces = run_.model.islands()[run_.model.island_of(i)].forces;
  return std::any_of(forces.begin(), forces.end(),
                     [](const Force* force) { return !force->conservative(); });
}

void EventMotions::set_forces(Flow& flow) {
  flow.island.forces =
      run_.model.islands()[run_.model.island_of(flow.island.bodies.front())].forces;
  flow.support.reset();
  for (std::size_t k = 0; k < flow.island.bodies.size(); ++k) {
    const BodyIndex i = flow.island.bodies[k];
    field_forces_[i] = field_forces_at(i);
    Vector3 force = net_force(i);
    if (const auto& support = bodies_[i].support) {
      for (int pass = 0; pass < 2; ++pass) {  // the first leaves roundoff of what it takes away
        force -= support->normal * support->normal.dot(force);
      }
      if (!flow.island.forces.empty()) {
        flow.support = std::make_unique<SupportForce>(support->normal);
        flow.island.forces.push_back(flow.support.get());
      }
    }
    flow.island.constant_force[k] = force;
  }
}

// --- What is told ------------------------------------------------------------------------------

void EventMotions::note(EventKind kind, BodyIndex a, BodyIndex b, Instant t, Grade grade) {
  Event event{.time = t, .kind = kind, .grade = grade, .a = a, .b = b};
  event.before_a = event.after_a = at(a, t);
  event.before_b = event.after_b = at(b, t);
  run_.note(event);
}

std::int64_t EventMotions::evaluations() const {
  std::int64_t sum = 0;
  for (const Flow& flow : flows_) {
    sum += flow.stepper->evaluations();
  }
  return sum;
}

void EventMotions::Rub::persist(Archive& archive) {
  archive(a, b, slides, rides, curved, spent, begun, force, along, arm_a, arm_b, belt_a, belt_b,
          from_a, from_b, booked);
}

void EventMotions::Flow::persist(Archive& archive) {
  archive(island.constant_force, exact, carried, held, states, launched, lost, booked,
          projection.velocity, projection.driven, projection.position);
  stepper->persist(archive);
}

void EventMotions::persist(Archive& archive) {
  if (archive.reading()) {
    for (Flow& flow : flows_) {
      flow.stepper->start(flow.island, Instant{}, flow.states);
    }
  }
  archive(now_, booked_, field_forces_);
  for (BodyIndex i = 0; i < bodies_.size(); ++i) {
    Motion motion = of(i);
    MovingBody& body = bodies_[i];
    archive(motion, body.support, body.fields, body.rubs, body.turns, body.worked);
    archive.require(body.turns ? body.worked.size() == 1 : body.worked.empty());
    if (archive.reading()) {
      keep_motion(i, motion);
    }
  }
  std::fill(riders_.begin(), riders_.end(), 0U);
  if (archive.reading()) {
    for (BodyIndex i = 0; i < bodies_.size(); ++i) {
      set_flight(i, of(i));
    }
  }
  for (const MovingBody& body : bodies_) {
    archive.require(!body.support || body.support->surface < bodies_.size());
    if (body.support) {
      ++riders_[body.support->surface];
    }
    for (const BodyIndex field : body.fields) {
      archive.require(field < bodies_.size());
    }
    for (const Rub& rub : body.rubs) {
      archive.require(rub.a < bodies_.size() && rub.b < bodies_.size());
    }
  }
  for (Flow& flow : flows_) {
    archive(flow);
  }
  if (archive.reading()) {
    for (Flow& flow : flows_) {
      const std::vector<Vector3> forces = field_forces_;  // as they were when it was launched
      const std::vector<Vector3> constant = flow.island.constant_force;
      set_forces(flow);
      flow.island.constant_force = constant;
      field_forces_ = forces;
    }
  }
}

}  // namespace core
}  // namespace kairos
