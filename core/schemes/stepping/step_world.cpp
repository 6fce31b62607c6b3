#include "core/schemes/stepping/step_world.hpp"

#include "core/archive.hpp"
#include "core/circular.hpp"

#include <algorithm>
#include <cmath>

namespace kairos {
inline namespace core {
Vector3 turn_between(const Quaternion& q0, const Quaternion& q1) {
  const Quaternion turn = q1 * q0.conjugate();
  const double sine = turn.vec().norm();
  if (!(sine > 0.0)) {
    return Vector3::Zero();
  }
  const double shorter = 2.0 * arc_tangent(sine, std::abs(turn.w()));
  return (turn.w() < 0.0 ? -shorter : shorter) / sine * turn.vec();
}

std::string stepping_refusal(const Model& model, const Method& method) {
  if (!model.grips().empty()) {
    return "it knows no hands, and the scene has some";
  }
  if (method.law->info().name != "newton") {
    return "its contacts rebound as Newton's restitution says; the impact law '" +
           std::string(method.law->info().name) + "' has no part in it; allowed: newton";
  }
  if (method.detector->info().at_step_ends) {
    return "detector '" + std::string(method.detector->info().name) +
           "' sees contacts only where an integrator ends its step, and none has a part in it";
  }
  return {};
}

StepWorld::StepWorld(const Model& model, const Method& method, const SchemeOptions& options,
                     Recorder& recorder, std::int64_t substeps, Corrects corrects)
    : run_(model, method, options, recorder),
      clock_(run_.options),
      broad_phase_(method.broad_phase(model.size())),
      swept_bounds_(method.swept_bounds),
      substeps_(substeps),
      corrects_(corrects),
      resumed_(!options.resume.empty()),
      bodies_(model.initial_state()),
      start_(bodies_),
      kicked_(bodies_),
      predicted_(bodies_),
      applied_(model.size()),
      applied_then_(model.size()),
      given_(model.size(), Vector3::Zero()),
      spin_response_(model.size(), Matrix3::Zero()),
      belt_(model.size(), Vector3::Zero()),
      contact_work_(model.size(), 0.0),
      poses_(model.size()) {
  run_.account.open(run_.time, bodies_);
  if (resumed_) {
    Archive archive(run_.options.resume);
    persist(archive);
  }
}

bool StepWorld::draw() {
  if (!resumed_) {
    check_finite();
    run_.account.balance(run_.time, bodies_);
    run_.recorder.stage(Stage::draw, 1.0);
    run_.recorder.frame({clock_.index(), run_.time, bodies_, run_.ledger});
    ++run_.cost.frames;
  }
  clock_.look(run_.time);
  if (clock_.whole() && !resumed_ && !run_.stopped()) {
    run_.offer_checkpoint(clock_.last(), [this](Archive& archive) { persist(archive); });
  }
  resumed_ = false;
  h_ = clock_.frame() / static_cast<double>(substeps_);
  return !run_.stopped() && clock_.advance();
}

RunResult StepWorld::result() && { return std::move(run_).result(std::move(bodies_)); }

// --- Forces and motion -------------------------------------------------------------------------

/// Gives driven bodies, for the whole step, the velocity that takes them to where their drive says.
void StepWorld::drive() {
  for (BodyIndex i = 0; i < bodies_.size(); ++i) {
    const Body& body = run_.model.body(i);
    if (run_.model.mobility(i) == Mobility::driven) {
      const Pose now = body.drive->motion(run_.time, h_).pose(0.0);
      const Pose then = body.drive->motion(run_.time + h_, h_).pose(0.0);
      bodies_[i] = {now,
                    {(then.position - now.position) / h_,
                     turn_between(now.orientation, then.orientation) / h_}};
    }
    if (!run_.model.is_free(i)) {
      belt_[i] = run_.model.entity(i).surface_velocity(body, bodies_[i]);
    }
  }
}

void StepWorld::act(Instant t, const State& bodies, std::vector<Wrench>& wrenches) {
  for (const Island& island : run_.model.islands()) {
    island_states_.clear();
    for (const BodyIndex i : island.bodies) {
      island_states_.push_back(bodies[i]);
    }
    island_wrenches_.assign(island.bodies.size(), Wrench{});
    island.wrenches(t, island_states_, island_wrenches_);
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
      wrenches[island.bodies[k]] = island_wrenches_[k];
      wrenches[island.bodies[k]].force += given_[island.bodies[k]];
    }
    run_.cost.right_hand_sides += 1;
  }
}

void StepWorld::begin_step() {
  drive();
  start_ = bodies_;
  fields_.act(run_, bodies_, given_);
  act(run_.time, start_, applied_);
  std::fill(contact_work_.begin(), contact_work_.end(), 0.0);
  ++run_.cost.steps;
}

void StepWorld::kick(double theta) {
  const auto kicked = [this](BodyIndex i, const BodyState& at, const Wrench& wrench) {
    const BodyInertia& inertia = run_.model.inertia(i);
    Twist change{h_ * wrench.force / inertia.mass, Vector3::Zero()};
    if (inertia.rotates) {
      change.angular = h_ * angular_acceleration(inertia, at, wrench.torque);
    }
    return change;
  };
  for (const BodyIndex i : run_.model.free_by_name()) {
    const Twist change = kicked(i, start_[i], applied_[i]);
    const BodyState& s = start_[i];
    bodies_[i].twist = {s.twist.linear + change.linear, s.twist.angular + change.angular};
    predicted_[i] = bodies_[i];
    predicted_[i].pose.position += h_ * s.twist.linear;
    if (run_.model.rotates(i)) {
      predicted_[i].pose.orientation = rotate(h_ * s.twist.angular, s.pose.orientation);
    }
  }
  if (theta > 0.0) {
    act(run_.time + h_, predicted_, applied_then_);
    for (const BodyIndex i : run_.model.free_by_name()) {
      const Twist now = kicked(i, start_[i], applied_[i]);
      const Twist then = kicked(i, predicted_[i], applied_then_[i]);
      const Twist& s = start_[i].twist;
      bodies_[i].twist = {s.linear + (1.0 - theta) * now.linear + theta * then.linear,
                          s.angular + (1.0 - theta) * now.angular + theta * then.angular};
    }
  }
  kicked_ = bodies_;
}

std::span<const Pose> StepWorld::poses_ahead(double ahead) {
  for (BodyIndex i = 0; i < start_.size(); ++i) {
    poses_[i] = start_[i].pose;
    if (ahead > 0.0 && run_.model.mobility(i) != Mobility::fixed) {
      poses_[i].position += ahead * start_[i].twist.linear;
      if (run_.model.mobility(i) == Mobility::driven || run_.model.rotates(i)) {
        poses_[i].orientation = rotate(ahead * start_[i].twist.angular, poses_[i].orientation);
      }
    }
  }
  return poses_;
}

void StepWorld::move(double theta) {
  for (const BodyIndex i : run_.model.free_by_name()) {
    const Twist& from = start_[i].twist;
    const Twist& to = bodies_[i].twist;
    const auto mean = [theta](const Vector3& x0, const Vector3& x1) {
      return theta == 1.0 ? x1 : Vector3((1.0 - theta) * x0 + theta * x1);
    };
    bodies_[i].pose.position = start_[i].pose.position + h_ * mean(from.linear, to.linear);
    if (run_.model.rotates(i)) {
      bodies_[i].pose.orientation =
          rotate(h_ * mean(from.angular, to.angular), start_[i].pose.orientation).normalized();
    }
  }
  for (BodyIndex i = 0; i < bodies_.size(); ++i) {
    if (run_.model.mobility(i) == Mobility::driven) {
      const auto& [pose, twist] = start_[i];
      bodies_[i].pose = {pose.position + h_ * twist.linear,
                         rotate(h_ * twist.angular, pose.orientation).normalized()};
    }
  }
}

Matrix3 StepWorld::inverse_inertia(BodyIndex i, const Quaternion& q) const {
  if (!run_.model.is_free(i) || !run_.model.rotates(i)) {
    return Matrix3::Zero();
  }
  return run_.model.inertia(i).inverse(q);
}

void StepWorld::end_step() {
  for (const StepContact& contact : contacts_) {
    book_contact(contact);
  }
  for (std::size_t k = 0; k < run_.model.islands().size(); ++k) {
    book_island(k);
  }
  tell_impacts();
  run_.time = run_.time + h_;
  for (BodyIndex i = 0; i < bodies_.size(); ++i) {
    if (run_.model.mobility(i) == Mobility::driven) {
      const Motion motion = run_.model.body(i).drive->motion(run_.time, h_);
      bodies_[i] = {motion.pose(0.0), motion.twist(0.0)};
    }
  }
}

void StepWorld::check_finite() {
  for (const BodyIndex i : run_.model.free_by_name()) {
    const BodyState& s = bodies_[i];
    if (!std::isfinite(s.pose.position.sum() + s.twist.linear.sum() + s.twist.angular.sum())) {
      return run_.stop("not finite: the state of '" + run_.model.body(i).name + "' overflowed");
    }
  }
}

void StepContact::persist(Archive& archive) { archive(a, b, impulse, point_A, fastest_approach); }

void StepWorld::persist(Archive& archive) {
  archive(run_.time, bodies_, run_.ledger, run_.cost, clock_, contacts_);
  for (const StepContact& contact : contacts_) {
    archive.require(contact.a < contact.b && contact.b < run_.model.size());
  }
  fields_.persist(archive, run_.model.size());
  run_.recorder.persist(archive);
}

}  // namespace core
}  // namespace kairos
