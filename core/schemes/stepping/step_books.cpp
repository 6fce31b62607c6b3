#include "core/schemes/stepping/step_world.hpp"

#include <algorithm>
#include <tuple>

namespace kairos {
inline namespace core {

void StepWorld::book_contact(const StepContact& c) {
  const Vector3& p = c.impulse;
  if (p.isZero(0.0)) {
    return;
  }
  const Vector3 after = relative_velocity(c, bodies_);
  const double normal = 0.5 * p[0] * (c.before[0] + after[0]);
  const double tangential =
      0.5 * (p[1] * (c.before[1] + after[1]) + p[2] * (c.before[2] + after[2]));
  double corrected = 0.0;
  if (corrects_ == Corrects::yes) {
    const double rebound = c.restitution * std::max(-c.before[0], 0.0);
    corrected = 0.5 * p[0] * (std::max(c.before[0], 0.0) + std::max(after[0] - rebound, 0.0));
    run_.ledger.add(EnergyLine::position_correction, corrected);
  }
  run_.ledger.add(EnergyLine::restitution_loss, normal - corrected);
  run_.ledger.add(c.begins ? EnergyLine::impact_friction : EnergyLine::friction, tangential);

  const Vector3 p_W = c.frame_W * p;
  for (const auto& [i, arm, sign] :
       {std::tuple{c.a, c.arm_a_W, -1.0}, std::tuple{c.b, c.arm_b_W, 1.0}}) {
    const Twist& from = start_[i].twist;
    const Twist& to = bodies_[i].twist;
    const Vector3 mean = 0.5 * ((from.linear + to.linear) + (from.angular + to.angular).cross(arm));
    const double work = sign * p_W.dot(mean);
    if (run_.model.is_free(i)) {
      contact_work_[i] += work;
      run_.ledger.exchange(work);
    } else {
      if (work != 0.0) {
        run_.ledger.add(EnergyLine::driven_work, -work);
      }
      if (!belt_[i].isZero(0.0)) {
        run_.ledger.add(EnergyLine::conveyor_and_hand, -sign * p_W.dot(belt_[i]));
      }
    }
  }
}

void StepWorld::book_island(std::size_t k) {
  const Island& island = run_.model.islands()[k];
  gather<BodyState>(island, start_, leg_from_);
  gather<BodyState>(island, bodies_, leg_to_);
  gather<Vector3>(island, given_, leg_given_);
  Leg leg{island, leg_from_, leg_to_, leg_given_};
  island_motions_.clear();
  for (const BodyIndex i : island.bodies) {
    leg.contact_work += contact_work_[i];
    if (run_.wants_motions || !island.forces.empty()) {
      island_motions_.push_back(way(i));
    }
    if (run_.wants_motions) {
      run_.recorder.motion(i, island_motions_.back());
    }
  }
  if (island.forces.empty()) {
    run_.account.leg(leg);
  } else {
    run_.account.leg(leg, island_motions_, run_.time, h_);
  }
}

/// The motion of body i in this step: straight, at a constant rate of turning.
Motion StepWorld::way(BodyIndex i) const {
  const BodyState& from = start_[i];
  const BodyState& to = bodies_[i];
  Motion motion;
  motion.start = run_.time;
  motion.duration = h_;
  motion.position =
      Polynomial<3>(from.pose.position, Vector3((to.pose.position - from.pose.position) / h_));
  motion.velocity =
      Polynomial<3>(from.twist.linear, Vector3((to.twist.linear - from.twist.linear) / h_));
  const Quaternion& q = from.pose.orientation;
  motion.quaternion = Polynomial<4>(Vector4(q.w(), q.x(), q.y(), q.z()));
  if (run_.model.rotates(i)) {
    motion.rotation = RotationKind::constant_rate;
    motion.rotation_rate = turn_between(q, to.pose.orientation) / h_;
    motion.angular_velocity =
        Polynomial<3>(from.twist.angular, Vector3((to.twist.angular - from.twist.angular) / h_));
  }
  return motion;
}

/// A pair that was apart, approached, and was pushed has had an impact.
void StepWorld::tell_impacts() {
  for (std::size_t k = 0; k < contacts_.size();) {
    const StepContact* deepest = &contacts_[k];
    bool hit = false;
    const BodyIndex a = contacts_[k].a;
    const BodyIndex b = contacts_[k].b;
    for (; k < contacts_.size() && contacts_[k].a == a && contacts_[k].b == b; ++k) {
      const StepContact& c = contacts_[k];
      hit = hit || (c.begins && c.before[0] < 0.0 && c.impulse[0] > 0.0);
      deepest = c.gap < deepest->gap ? &c : deepest;
    }
    if (!hit) {
      continue;
    }
    Event event{.time = run_.time + h_, .kind = EventKind::impact, .a = a, .b = b};
    event.contact = {start_[a].pose.position + deepest->arm_a_W, deepest->normal_W(), deepest->gap,
                     deepest->restitution, deepest->friction};
    event.before_a = start_[a];
    event.after_a = bodies_[a];
    event.before_b = start_[b];
    event.after_b = bodies_[b];
    ++run_.cost.impacts;
    run_.note(event);
  }
}

}  // namespace core
}  // namespace kairos
