#include "core/schemes/event/event_motions.hpp"

#include "core/archive.hpp"
#include "core/joint_system.hpp"
#include "core/large_pages.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace kairos {
inline namespace core {

namespace {

MemorylessStepper* as_memoryless(Stepper& stepper) {
  return dynamic_cast<MemorylessStepper*>(&stepper);
}

}  // namespace

EventMotions::EventMotions(EventRun& run, const Method& method)
    : run_(run),
      method_(method),
      table_(run.model),
      ties_(run.model.size()),
      riders_(run.model.size(), 0),
      ways_(run.model.size(), 0),
      flows_(run.model.islands().size()),
      shares_(run.model.islands().size(), 0),
      booked_until_(scattered<Instant>(run.model.size())),
      now_(scattered<BodyState>(run.model.size())) {
  const State initial = run.model.initial_state();
  std::copy(initial.begin(), initial.end(), now_.begin());
  for (BodyIndex i = 0; i < now_.size(); ++i) {
    if (!run_.model.is_free(i)) {
      led_.push_back(i);
      aside_.push_back(now_[i]);
    }
  }
  for (std::size_t k = 0; k < flows_.size(); ++k) {
    shares_[k] = static_cast<char>(may_share(k));
    if (shares_[k] == 0) {
      flows_[k] = make_flow(k);
      motions_.resize(std::max(motions_.size(), flows_[k]->states.size()));
    }
  }
  run_.account.open(run_.time, now_);
}

// --- Flows -------------------------------------------------------------------------------------

std::unique_ptr<EventMotions::Flow> EventMotions::make_flow(std::size_t island) const {
  auto flow = std::make_unique<Flow>(run_.model, method_, island);
  flow->exact = flow->stepper->info().order == 0;
  flow->gather(now_);
  flow->booked = flow->states;
  return flow;
}

/// Whether an island is one body that falls freely and does not turn, so that all such islands can
/// share one stepper: its data beside the motion are made anew each time it is looked at.
bool EventMotions::may_share(std::size_t island) {
  const Island& of = run_.model.islands()[island];
  if (of.bodies.size() != 1 || !of.forces.empty() || of.joints != nullptr ||
      !run_.model.closed_form(island) || run_.model.rotates(of.bodies.front()) ||
      run_.options.roundoff) {
    return false;
  }
  if (shared_ == nullptr) {
    auto flow = make_flow(island);
    falling_ = as_memoryless(*flow->stepper);
    if (falling_ == nullptr) {
      return false;
    }
    flow->stepper->start(flow->island, run_.time, flow->states);
    shared_ = std::move(flow);
    motions_.resize(std::max<std::size_t>(motions_.size(), 1));
    return true;
  }
  const std::unique_ptr<Stepper> stepper = method_.stepper(run_.model, island);
  return as_memoryless(*stepper) != nullptr &&
         stepper->info().name == shared_->stepper->info().name;
}

EventMotions::Flow& EventMotions::flow_of(BodyIndex i) {
  const std::size_t k = run_.model.island_of(i);
  if (flows_[k] != nullptr) {
    return *flows_[k];
  }
  if (shared_->number != k) {
    shared_->number = k;
    shared_->island.bodies[0] = i;
    shared_->island.inertia[0] = run_.model.inertia(i);
  }
  return *shared_;
}

EventMotions::Flow& EventMotions::own_flow(BodyIndex i) {
  const std::size_t k = run_.model.island_of(i);
  if (flows_[k] == nullptr) {
    ways_[i] &= ~untied_bit;
    flows_[k] = make_flow(k);
    Flow& flow = *flows_[k];
    flow.states[0] = flow.booked[0] = at(i, booked_until(flow));
    flow.stepper->start(flow.island, booked_until(flow), flow.states);
  }
  return *flows_[k];
}

EventMotions::Flow& EventMotions::flow_to_launch(BodyIndex i) {
  const std::size_t k = run_.model.island_of(i);
  if (shares_[k] == 0) {
    return *flows_[k];
  }
  if (ties(i).any() || (flows_[k] != nullptr && flows_[k]->carried)) {
    return own_flow(i);
  }
  if (flows_[k] != nullptr) {
    evaluations_ += flows_[k]->stepper->evaluations();
    flows_[k].reset();
  }
  return flow_of(i);
}

EventMotions::Ties& EventMotions::tie(BodyIndex i) {
  ways_[i] &= ~untied_bit;
  if (ties_[i] == nullptr) {
    ties_[i] = std::make_unique<Ties>();
  }
  return *ties_[i];
}

void EventMotions::forget_surface_forces(BodyIndex i) {
  if (ties_[i] != nullptr) {
    ties_[i]->surface_forces.clear();
    ties_[i]->turns = false;
    ties_[i]->worked.clear();
  }
}

void EventMotions::begin() {
  for (const BodyIndex i : run_.agenda.by_name()) {
    switch (run_.model.mobility(i)) {
      case Mobility::fixed:
        keep_motion(i, Motion::at_rest(run_.time, now_[i].pose));
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
      if (is_shared(flow)) {
        flow.stepper->restart(flow.island, run_.time, flow.states);
      } else {
        flow.stepper->start(flow.island, run_.time, flow.states);
      }
      next_segment(flow, run_.time);
    }
  }
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
    if (is_plain(i)) {
      if (!book_plain(i, t)) {
        bring(i, t);
      }
      continue;
    }
    if (run_.model.is_free(i)) {
      book(i, t);
    }
    if (run_.model.mobility(i) != Mobility::fixed) {
      bring(i, t);
    }
  }
}

/// A step that was left out before a launch would give a wrong ledger or a wrong motion, and no
/// error.
void EventMotions::check_ready([[maybe_unused]] BodyIndex first, [[maybe_unused]] Instant t) const {
  assert(!(booked_until_[island(first).front()] < t));
  assert(std::all_of(island(first).begin(), island(first).end(),
                     [&](BodyIndex k) { return run_.jumps.is_brought(k, t); }));
}

void EventMotions::launch(BodyIndex i, Instant t) {
  if (is_plain(i) && launch_plain(i, t)) {
    return;
  }
  for (const BodyIndex k : island(i)) {
    forget_surface_forces(k);
  }
  Flow& flow = flow_to_launch(i);
  check_ready(i, t);
  flow.held = false;
  set_forces(flow);
  if (flow.island.joints != nullptr) {
    put_onto_joints(i, t);
  }
  flow.gather(now_);
  flow.stepper->restart(flow.island, t, flow.states);
  next_segment(flow, t);
}

/// `launch` of a body of which its flight says all, without a motion in between; false where that
/// is not enough.
bool EventMotions::launch_plain(BodyIndex i, Instant t) {
  if (run_.wants_motions || !table_.goes_on_as_parabola(i, now_[i])) {
    return false;
  }
  check_ready(i, t);
  return fly_on(i, now_[i], run_.model.gravity_force(i), run_.model.inertia(i).mass, t);
}

/// A plain body goes on from `state`; false, and nothing has changed, where its stepper has to be
/// asked for its motion.
bool EventMotions::fly_on(BodyIndex i, const BodyState& state, const Vector3& weight, double mass,
                          Instant t) {
  const auto acceleration = falling_->fall(weight + Vector3(Vector3::Zero()), mass);
  if (!acceleration) {
    return false;
  }
  const bool was_usual = (ways_[i] & usual_bit) != 0;
  if (!was_usual || !table_.keep_usual(i, state, *acceleration, t)) {
    table_.keep_parabola(i, state, *acceleration, t);
    if (was_usual && !table_.is_usual(i)) {
      ways_[i] &= ~usual_bit;
    }
  }
  booked_until_[i] = t;
  ++run_.cost.steps;
  run_.agenda.renew(i);
  if constexpr (watches_jumps) {
    run_.jumps.launched(i);
  }
  return true;
}

BodyState EventMotions::open_ball(BodyIndex i, const PlainBall& ball, Instant t) {
  const BodyState state = fallen(flight(i), t);
  Instant& until = booked_until_[i];
  if (t - until > 0.0) {
    if (!ball.weight.isZero(0.0)) {
      run_.account.fallen(ball, at(i, until), state);
    }
    until = t;
  }
  if constexpr (watches_jumps) {
    bring(i, t);
  }
  return state;
}

void EventMotions::launch_ball(BodyIndex i, const PlainBall& ball, const BodyState& state,
                               Instant t) {
  if constexpr (watches_jumps) {
    check_ready(i, t);
  }
  if (run_.wants_motions || !fly_on(i, state, ball.weight, ball.mass, t)) {
    now_[i] = state;
    launch(i, t);
  }
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
  check_ready(i, t);
  flow.held = true;
  for (std::size_t k = 0; k < flow.states.size(); ++k) {
    const BodyIndex body = flow.island.bodies[k];
    forget_surface_forces(body);
    flow.states[k] = flow.booked[k] = now_[body];
    set_motion(body, Motion::at_rest(t, now_[body].pose));
  }
  booked_until(flow) = t;
  flow.projection = {};
}

void EventMotions::hold(BodyIndex i, Instant t, const Motion& motion) {
  hold(i, t, Twist{motion.acceleration(0.0), Vector3::Zero()});
  set_motion(i, motion);
}

void EventMotions::turn(BodyIndex i, Instant t, const Turn& turn) {
  hold(i, t, Twist{});
  begin_turn(i, flow_of(i), 0, turn);
}

void EventMotions::turn_together(BodyIndex i, Instant t, std::span<const Turn> turns) {
  Flow& flow = own_flow(i);
  check_ready(i, t);
  flow.held = true;
  set_forces(flow);
  booked_until(flow) = t;
  flow.projection = {};
  for (std::size_t k = 0; k < turns.size(); ++k) {
    flow.booked[k] = now_[flow.island.bodies[k]];
  }
  if (run_.options.roundoff) {
    flow.launched = flow.booked;
    flow.lost = 0.0;
  }
  for (std::size_t k = 0; k < turns.size(); ++k) {
    forget_surface_forces(flow.island.bodies[k]);
    begin_turn(flow.island.bodies[k], flow, k, turns[k]);
  }
}

void EventMotions::begin_turn(BodyIndex i, Flow& flow, std::size_t place, const Turn& turn) {
  Ties& tied = tie(i);
  tied.turns = true;
  tied.worked.assign(1, turn.worked);
  flow.states[place] = turn.end;
  set_motion(i, turn.motion);
}

void EventMotions::hold(BodyIndex i, Instant t, const Twist& acceleration) {
  Flow& flow = own_flow(i);
  check_ready(i, t);
  flow.held = true;
  set_support(i, std::nullopt);
  forget_surface_forces(i);
  set_forces(flow);
  flow.island.constant_force[0] = run_.model.inertia(i).mass * acceleration.linear;
  flow.states[0] = flow.booked[0] = now_[i];
  booked_until(flow) = t;
  if (run_.options.roundoff) {
    flow.launched = flow.states;
    flow.lost = 0.0;
  }
  Motion motion = Motion::ballistic(t, std::numeric_limits<double>::infinity(), now_[i].pose,
                                    now_[i].twist, acceleration.linear);
  if (!acceleration.angular.isZero(0.0)) {
    // Only spheres come here. Their spin is followed; their orientation is not, as it changes
    // nothing.
    motion.rotation = RotationKind::constant_rate;
    motion.angular_velocity = Polynomial<3>(now_[i].twist.angular, acceleration.angular);
  }
  set_motion(i, motion);
}

void EventMotions::add_surface_force(BodyIndex i, Instant t, SurfaceForce force) {
  force.from_a = at(force.a, t);
  force.from_b = at(force.b, t);
  force.booked = force.begun = t;
  tie(i).surface_forces.push_back(force);
}

void EventMotions::go_on(BodyIndex i, Instant t) {
  if (run_.model.mobility(i) == Mobility::driven) {
    return drive(i, t);
  }
  book(i, t);
  if (support(i)) {
    bring(i, t);  // its surface took it there; the stepper does not know
    launch(i, t);
  } else {
    next_segment(flow_of(i), t);
  }
}

/// The step that was to begin here failed: there is no motion from here on, but bodies are here.
void EventMotions::stay_at_start(Flow& flow, Instant t) {
  if (!is_shared(flow)) {
    flow.states = flow.booked;
  }
  for (std::size_t k = 0; k < flow.states.size(); ++k) {
    const BodyState& here = flow.states[k];
    set_motion(flow.island.bodies[k], Motion::ballistic(t, std::numeric_limits<double>::infinity(),
                                                        here.pose, here.twist, Vector3::Zero()));
  }
  flow.projection = {};
}

/// Takes one step of the stepper, and makes motions of it.
void EventMotions::next_segment(Flow& flow, Instant t) {
  if (!is_shared(flow)) {
    flow.booked = flow.states;
  }
  booked_until(flow) = t;
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
    stay_at_start(flow, t);
    run_.stop(t, "integrator: " + std::string(step.reason));
    return;
  }
  flow.projection = step.projection;
  flow.exact = flow.stepper->info().order == 0;  // a closed form may have given up
  const std::span motions(motions_.data(), flow.states.size());
  for (Motion& motion : motions) {  // not every stepper sets these
    motion.rotation_rate.setZero();
    motion.error_radius = 0.0;
  }
  flow.stepper->dense_output(motions);
  for (std::size_t k = 0; k < motions.size(); ++k) {
    set_motion(flow.island.bodies[k], motions[k]);
  }
  hold(flow, t);
  const BodyIndex first = flow.island.bodies.front();
  assert(!is_shared(flow) || std::isinf(step.advanced));
  if (std::isfinite(step.advanced)) {
    run_.agenda.push(t + step.advanced, DueKind::segment_end, first, first);
  }
}

/// The next motion of a driven body.
void EventMotions::drive(BodyIndex i, Instant t) {
  set_motion(i, run_.model.body(i).drive->motion(t, run_.epoch()));
  bring(i, t);
  run_.agenda.push(end_of(i), DueKind::segment_end, i, i);
}

Motion EventMotions::driven_from(BodyIndex i, Instant t) const {
  return t < end_of(i) ? of(i) : run_.model.body(i).drive->motion(t, run_.epoch());
}

void EventMotions::keep_motion(BodyIndex i, const Motion& motion) {
  table_.keep(i, motion);
  ways_[i] = 0;
  if (motion.position.degree() > 2 || !std::holds_alternative<Sphere>(run_.model.shape(i)) ||
      !run_.model.is_free(i) || support(i) || !std::isinf(motion.duration)) {
    return;
  }
  const std::size_t k = run_.model.island_of(i);
  const bool untied = shares_[k] != 0 && !run_.model.is_field(i) && flows_[k] == nullptr &&
                      !ties(i).any() && ties(i).field_force.isZero(0.0);
  ways_[i] =
      static_cast<std::uint8_t>(flies_bit | (table_.is_parabola(i) ? parabola_bit : 0) |
                                (untied ? untied_bit : 0) | (table_.is_usual(i) ? usual_bit : 0));
}

void EventMotions::set_motion(BodyIndex i, const Motion& motion) {
  keep_motion(i, motion);
  run_.agenda.renew(i);
  if constexpr (watches_jumps) {
    run_.jumps.launched(i);
  }
  if (run_.wants_motions) {
    tell_motion(i, motion);
  }
}

void EventMotions::tell_motion(BodyIndex i, const Motion& motion) {
  if (run_.boxes_crossed.empty() || is_zero(run_.boxes_crossed[i])) {
    return run_.recorder.motion(i, motion);
  }
  Motion told = motion;
  told.position[0] += run_.recorded_offset(i);
  run_.recorder.motion(i, told);
}

void EventMotions::go_on_as(BodyIndex i, const Image& n) {
  const Vector3 shift = run_.model.scene().periodic->shift(n);
  Motion motion = of(i);
  motion.position[0] += shift;
  keep_motion(i, motion);
  now_[i].pose.position += shift;
  if (Flow& flow = flow_of(i); !is_shared(flow)) {
    const auto place = std::find(flow.island.bodies.begin(), flow.island.bodies.end(), i);
    flow.booked[static_cast<std::size_t>(place - flow.island.bodies.begin())].pose.position +=
        shift;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    run_.boxes_crossed[i][k] -= n[k];
  }
}

void EventMotions::set_support(BodyIndex i, const std::optional<Support>& support) {
  if (const auto& before = ties(i).support) {
    --riders_[before->surface];
  }
  if (support) {
    ++riders_[support->surface];
    tie(i).support = support;
  } else if (ties_[i] != nullptr) {
    ties_[i]->support.reset();
  }
}

void EventMotions::set_fields(BodyIndex i, std::vector<BodyIndex> fields) {
  if (ties_[i] != nullptr || !fields.empty()) {
    tie(i).fields = std::move(fields);
  }
}

/// Makes a supported ball ride on its surface, until the face ends or draws away.
void EventMotions::hold(Flow& flow, Instant t) {
  const BodyIndex i = flow.island.bodies.front();
  const std::optional<Support>& support = ties(i).support;
  if (!support) {
    return;
  }
  Motion motion = of(i);
  const Vector3& n = support->normal;
  const BodyIndex surface = support->surface;
  const double mass = flow.island.inertia[0].mass;
  const Motion under = of(surface).shifted(t - start_of(surface));
  const double left = std::min({run_.epoch_end() - t, under.duration, motion.duration});
  double until =
      face_exit_time(run_.model.shape(surface), under, motion, n, motion.position[0], left);
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
      return n.dot(mass * under.acceleration(s) - acting(i, t + s, state).force);
    };
    until = std::min(until, release_time(contact_force, std::min(until, left)));
  }
  run_.push_in_epoch(t + until, DueKind::support_ends, i, surface);
}

void EventMotions::carry(BodyIndex i, BodyIndex hand, const BodyState& state, Instant t) {
  Flow& flow = own_flow(i);
  now_[i] = state;
  mark_brought(i, t);
  run_.account.carried(flow.island, t, flow.booked, {&state, 1});
  flow.booked[0] = state;
  booked_until(flow) = t;
  flow.carried = true;
  Motion motion = of(hand).shifted(t - start_of(hand));
  motion.rotation = RotationKind::fixed;
  motion.quaternion = Motion::at_rest(t, state.pose).quaternion;
  motion.angular_velocity = {};
  set_motion(i, motion);
  if constexpr (watches_jumps) {
    run_.jumps.launched(i, false);
  }
}

// --- Forces ------------------------------------------------------------------------------------

bool EventMotions::is_in_field(BodyIndex i, BodyIndex field) const {
  const std::vector<BodyIndex>& fields = ties(i).fields;
  return std::find(fields.begin(), fields.end(), field) != fields.end();
}

Vector3 EventMotions::field_forces_at(BodyIndex i) const {
  Vector3 sum = Vector3::Zero();
  if (is_plain(i)) {
    return sum;
  }
  for (const BodyIndex field : ties(i).fields) {
    sum += field_force(run_.model, field, now_[field], i);
  }
  return sum;
}

/// The force that is constant over a segment, N.
Vector3 EventMotions::net_force(BodyIndex i) const {
  return run_.model.gravity_force(i) + ties(i).field_force;
}

Wrench EventMotions::acting(BodyIndex i, Instant t, const BodyState& state) const {
  Wrench wrench{steady_force(i), Vector3::Zero()};
  const Island& island = run_.model.islands()[run_.model.island_of(i)];
  if (island.bodies.size() == 1 && island.joints == nullptr) {
    for (const Force* force : island.forces) {
      force->add(t, {&state, 1}, {&wrench, 1});
    }
  }
  return wrench;
}

double EventMotions::pressing(BodyIndex ball, const Support& support, Instant t, bool held) const {
  const auto surface_acceleration = [&](BodyIndex surface) {
    const auto riding = moving(surface);
    const Motion& under = riding.motion();
    return under.acceleration(std::min(t - under.start, under.duration));
  };
  Vector3 own = acting(ball, t, now_[ball]).force / run_.model.inertia(ball).mass;
  if (const std::optional<Support>& other = ties(ball).support; held && other) {
    own += other->normal * other->normal.dot(surface_acceleration(other->surface) - own);
  }
  return support.normal.dot(surface_acceleration(support.surface) - own);
}

bool EventMotions::is_damped(BodyIndex i) const {
  if (is_plain(i) || !run_.model.is_free(i)) {
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
    if (ties_[i] != nullptr) {
      ties_[i]->field_force = field_forces_at(i);
    }
    Vector3 force = net_force(i);
    if (const auto& support = ties(i).support) {
      for (int pass = 0; pass < 2; ++pass) {  // the first leaves its own roundoff
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

void EventMotions::note(EventKind kind, BodyIndex a, BodyIndex b, Instant t) {
  note({.time = t, .kind = kind, .a = a, .b = b});
}

void EventMotions::note(Event event) {
  event.before_a = event.after_a = at(event.a, event.time);
  event.before_b = event.after_b = at(event.b, event.time);
  run_.note(event);
}

std::int64_t EventMotions::evaluations() const {
  std::int64_t sum = evaluations_ + (shared_ != nullptr ? shared_->stepper->evaluations() : 0);
  for (const auto& flow : flows_) {
    sum += flow != nullptr ? flow->stepper->evaluations() : 0;
  }
  return sum;
}

void EventMotions::SurfaceForce::persist(Archive& archive) {
  archive(a, b, slides, rides, curved, spent, begun, force, along, arm_a, arm_b, belt_a, belt_b,
          from_a, from_b, booked);
}

void EventMotions::Ties::persist(Archive& archive) {
  archive(support, fields, field_force, surface_forces, turns, worked);
  archive.require(turns ? worked.size() == 1 : worked.empty());
}

void EventMotions::Flow::persist(Archive& archive) {
  archive(island.constant_force, exact, carried, held, states, launched, lost, booked,
          projection.velocity, projection.driven, projection.position);
  stepper->persist(archive);
}

void EventMotions::persist_bodies(Archive& archive) {
  for (BodyIndex i = 0; i < ties_.size(); ++i) {
    Motion motion = of(i);
    bool tied = ties_[i] != nullptr;
    archive(motion, tied);
    if (tied) {
      archive(tie(i));
    }
    if (archive.reading()) {
      keep_motion(i, motion);
    }
  }
  std::fill(riders_.begin(), riders_.end(), 0U);
  for (BodyIndex i = 0; i < ties_.size(); ++i) {
    archive.require(!support(i) || support(i)->surface < ties_.size());
    if (support(i)) {
      ++riders_[support(i)->surface];
    }
    for (const BodyIndex field : fields(i)) {
      archive.require(field < ties_.size());
    }
    for (const SurfaceForce& force : ties(i).surface_forces) {
      archive.require(force.a < ties_.size() && force.b < ties_.size());
    }
  }
}

void EventMotions::persist(Archive& archive) {
  archive(now_, aside_);
  persist_bodies(archive);
  std::int64_t gone = evaluations_ + (shared_ != nullptr ? shared_->stepper->evaluations() : 0);
  archive(gone);
  evaluations_ = archive.reading() ? gone : evaluations_;
  for (std::size_t k = 0; k < flows_.size(); ++k) {
    const BodyIndex first = run_.model.islands()[k].bodies.front();
    bool own = flows_[k] != nullptr;
    archive(own, booked_until_[first]);
    archive.require(own || shares_[k] != 0);
    if (!own) {
      continue;
    }
    Flow& flow = own_flow(first);
    if (archive.reading()) {
      flow.stepper->start(flow.island, Instant{}, flow.states);
    }
    archive(flow);
    if (archive.reading()) {
      set_forces_as_launched(flow);
    }
  }
}

/// Restores what a checkpoint leaves out; forces are those of the launch.
void EventMotions::set_forces_as_launched(Flow& flow) {
  const std::vector<Vector3> constant = flow.island.constant_force;
  given_.clear();
  for (const BodyIndex i : flow.island.bodies) {
    given_.push_back(ties(i).field_force);
  }
  set_forces(flow);
  flow.island.constant_force = constant;
  for (std::size_t k = 0; k < given_.size(); ++k) {
    if (const BodyIndex i = flow.island.bodies[k]; ties_[i] != nullptr) {
      ties_[i]->field_force = given_[k];
    }
  }
}

}  // namespace core
}  // namespace kairos
