#include "core/schemes/stepping/step_world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace kairos {
inline namespace core {
namespace {

/// Gap that counts as touching, m: the tolerance of contacts, by default 1e-9 of the smaller extent
/// and the roundoff of the coordinates.
double touching(const SchemeRun& run, BodyIndex a, BodyIndex b, std::span<const Pose> poses) {
  if (run.options.toi_tolerance > 0.0) {
    return run.options.toi_tolerance;
  }
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  return 1e-9 * std::min(smallest_extent(run.model.shape(a)), smallest_extent(run.model.shape(b))) +
         8.0 * epsilon *
             (poses[a].position.lpNorm<Eigen::Infinity>() +
              poses[b].position.lpNorm<Eigen::Infinity>());
}

}  // namespace

void StepWorld::find_contacts(std::span<const Pose> poses, double reach) {
  last_contacts_.swap(contacts_);
  contacts_.clear();
  for (BodyIndex i = 0; i < poses.size(); ++i) {
    const Motion still = Motion::at_rest(run_.time, poses[i]);
    Aabb box = swept_bounds_({run_.model.shape(i), still}, {run_.time, 0.0});
    box.lower.array() -= reach;
    box.upper.array() += reach;
    broad_phase_->update(i, box);
    if (run_.model.is_free(i)) {
      spin_response_[i] = inverse_inertia(i, poses[i].orientation);
    }
  }
  for (BodyIndex i = 0; i < poses.size(); ++i) {
    if (!run_.model.is_free(i)) {
      continue;
    }
    near_.clear();
    broad_phase_->candidates(i, near_);
    for (const BodyIndex k : near_) {
      const bool once = !run_.model.is_free(k) || i < k;
      if (once && run_.model.interacts(i, k) && !run_.model.is_field(i) &&
          !run_.model.is_field(k)) {
        add_contacts(std::min(i, k), std::max(i, k), poses, reach);
      }
    }
  }
  std::stable_sort(contacts_.begin(), contacts_.end(),
                   [](const StepContact& x, const StepContact& y) {
                     return std::tie(x.a, x.b) < std::tie(y.a, y.b);
                   });
  recognise();
}

void StepWorld::add_contacts(BodyIndex a, BodyIndex b, std::span<const Pose> poses, double reach) {
  ++run_.cost.overlap_tests;
  const ContactManifold manifold =
      run_.detector.manifold(run_.model.shape(a), poses[a], run_.model.shape(b), poses[b],
                             std::max(touching(run_, a, b, poses), reach));
  for (std::size_t k = 0; k < manifold.size; ++k) {
    const auto& [position, gap] = manifold.points[k];
    StepContact c;
    c.a = a;
    c.b = b;
    c.gap = gap;
    c.restitution = run_.model.restitution(a, b);
    c.friction = run_.model.friction(a, b);
    c.arm_a_W = position - poses[a].position;
    c.arm_b_W = position - poses[b].position;
    c.point_A = poses[a].to_body(position);
    int least = 0;
    manifold.normal.cwiseAbs().minCoeff(&least);
    c.frame_W.col(0) = manifold.normal;
    c.frame_W.col(1) = manifold.normal.cross(Vector3::Unit(least)).normalized();
    c.frame_W.col(2) = manifold.normal.cross(c.frame_W.col(1));
    Matrix3 response = Matrix3::Zero();
    for (const auto& [i, arm] : {std::pair{a, c.arm_a_W}, std::pair{b, c.arm_b_W}}) {
      if (run_.model.is_free(i)) {
        Matrix3 cross;
        cross << 0.0, -arm.z(), arm.y(), arm.z(), 0.0, -arm.x(), -arm.y(), arm.x(), 0.0;
        response += inverse_mass(i) * Matrix3::Identity() - cross * spin_response_[i] * cross;
      }
    }
    c.compliance = c.frame_W.transpose() * response * c.frame_W;
    c.before = relative_velocity(c, start_);
    contacts_.push_back(c);
  }
}

/// Gives each contact the impulse of one contact of the last step, and each of those to one contact
/// only: the nearest on the surface of a, within a tenth of the smaller body. A single point, which
/// may roll, continues the single point of the last step.
void StepWorld::recognise() {
  const auto less = [](const StepContact& x, const StepContact& y) {
    return std::tie(x.a, x.b) < std::tie(y.a, y.b);
  };
  for (auto first = contacts_.begin(); first != contacts_.end();) {
    const auto last = std::upper_bound(first, contacts_.end(), *first, less);
    const auto old = std::equal_range(last_contacts_.begin(), last_contacts_.end(), *first, less);
    const bool single = last - first == 1 && old.second - old.first == 1;
    const double near = 0.1 * std::min(smallest_extent(run_.model.shape(first->a)),
                                       smallest_extent(run_.model.shape(first->b)));
    const bool begins = std::none_of(old.first, old.second,
                                     [](const StepContact& o) { return o.impulse[0] > 0.0; });
    for (auto c = first; c != last; ++c) {
      c->begins = begins;
      StepContact* best = nullptr;
      double distance = near;
      for (auto o = old.first; o != old.second; ++o) {
        const double d = (o->point_A - c->point_A).norm();
        if (!o->taken && (d <= distance || single)) {
          distance = d;
          best = &*o;
        }
      }
      if (best != nullptr) {
        best->taken = true;
      }
      c->impulse = best != nullptr ? best->impulse : Vector3::Zero();
      c->fastest_approach = std::max(best != nullptr ? best->fastest_approach : 0.0, -c->before[0]);
    }
    first = last;
  }
}

Vector3 StepWorld::relative_velocity(const StepContact& c, const State& bodies) const {
  const Twist& a = bodies[c.a].twist;
  const Twist& b = bodies[c.b].twist;
  const Vector3 u = (b.linear + b.angular.cross(c.arm_b_W) + belt_[c.b]) -
                    (a.linear + a.angular.cross(c.arm_a_W) + belt_[c.a]);
  return c.frame_W.transpose() * u;
}

void StepWorld::push(const StepContact& c, const Vector3& impulse) {
  const Vector3 p = c.frame_W * impulse;
  if (run_.model.is_free(c.a)) {
    bodies_[c.a].twist.linear -= inverse_mass(c.a) * p;
    bodies_[c.a].twist.angular -= spin_response_[c.a] * c.arm_a_W.cross(p);
  }
  if (run_.model.is_free(c.b)) {
    bodies_[c.b].twist.linear += inverse_mass(c.b) * p;
    bodies_[c.b].twist.angular += spin_response_[c.b] * c.arm_b_W.cross(p);
  }
}

void StepWorld::sum_impulses() {
  for (const BodyIndex i : run_.model.free_by_name()) {
    bodies_[i].twist = kicked_[i].twist;
  }
  for (const StepContact& contact : contacts_) {
    push(contact, contact.impulse);
  }
}

}  // namespace core
}  // namespace kairos
