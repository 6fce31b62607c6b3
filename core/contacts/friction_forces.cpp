#include "core/contacts/friction_forces.hpp"

#include "core/circular.hpp"
#include "core/contacts/least_norm.hpp"
#include "core/contacts/nonnegative_solve.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

using Does = FrictionChoice::Does;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Rays that stand for a cone: it is nowhere farther from their hull than 2 % of its width.
constexpr int rays_of_cone = 16;

void align(FrictionTouch& t, const Vector3& along) {
  const double length = along.norm();
  t.t1 = length > 0.0 ? Vector3(along / length) : t.n.unitOrthogonal();
  t.t1 = (t.t1 - t.n * t.n.dot(t.t1)).normalized();
  t.t2 = t.n.cross(t.t1);
}

/// Both bodies of a touch, with the sign of the force on them.
std::array<std::pair<std::size_t, double>, 2> sides(const FrictionTouch& t) {
  return {{{t.a, -1.0}, {t.b, 1.0}}};
}

}  // namespace

FrictionForces::FrictionForces(const ContactGroup& group) : group_(group) {
  double lightest = 0.0;  // 1/kg
  for (std::size_t i = 0; i < group.bodies.size(); ++i) {
    load_ = std::max(
        load_, group.loads[i].linear.norm() + group.loads[i].angular.norm() * group.radius[i]);
    first_.push_back(unknowns_);
    balance_.push_back(balances_);
    if (moves(group.bodies[i])) {
      lightest = std::max(lightest, group.bodies[i].inverse_mass);
      unknowns_ += turns(i) ? 6 : 3;
      balances_ += can_turn(i) ? 6 : 3;
    }
  }
  if (lightest > 0.0) {
    unit_ = std::ldexp(1.0, std::ilogb(lightest));
  }
}

void FrictionForces::add(FrictionTouch touch, const Vector3& along) {
  align(touch, along);
  touches_.push_back(std::move(touch));
}

bool FrictionForces::turns(std::size_t i) const {
  return group_.round[i] != 0 && !group_.bodies[i].inverse_inertia.isZero(0.0);
}

bool FrictionForces::can_turn(std::size_t i) const {
  return !group_.bodies[i].inverse_inertia.isZero(0.0);
}

/// Arm from the origin of body i, which is one of touch t, to the point where it touches.
Vector3 FrictionForces::arm(const FrictionTouch& t, std::size_t i, const Vector3& point) const {
  if (group_.round[i] != 0) {
    return t.n * (i == t.a ? group_.radius[i] : -group_.radius[i]);
  }
  return point - group_.bodies[i].position;
}

Vector3 FrictionForces::relative(const FrictionTouch& t, const std::vector<Twist>& v) const {
  const Vector3& point = group_.patches[t.patch].manifold.points[0].position;
  const auto at = [&](std::size_t i) -> Vector3 {
    const bool round = group_.round[i] != 0;
    return round ? Vector3(v[i].linear + v[i].angular.cross(arm(t, i, point))) : v[i].linear;
  };
  return at(t.b) - at(t.a);
}

/// Row of J for the relative motion along d.
VectorXd FrictionForces::row(const FrictionTouch& t, const Vector3& d) const {
  VectorXd out = VectorXd::Zero(unknowns_);
  const Vector3& point = group_.patches[t.patch].manifold.points[0].position;
  for (const auto& [i, sign] : sides(t)) {
    const GroupBody& body = group_.bodies[i];
    if (!moves(body)) {
      continue;
    }
    out.segment<3>(first_[i]) = sign * std::sqrt(body.inverse_mass / unit_) * d;
    if (turns(i)) {
      out.segment<3>(first_[i] + 3) =
          sign * std::sqrt(body.inverse_inertia(0, 0) / unit_) * arm(t, i, point).cross(d);
    }
  }
  return out;
}

FrictionForces::Constraints FrictionForces::constraints(
    const std::vector<FrictionChoice>& choices, const std::vector<Twist>& velocities) const {
  std::vector<std::pair<std::size_t, Vector3>> all;
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    const FrictionTouch& t = touches_[k];
    if (choices[k].does != Does::opens) {
      all.emplace_back(k, t.n);
    }
    if (choices[k].does == Does::sticks) {
      all.emplace_back(k, t.t1);
      all.emplace_back(k, t.t2);
    }
  }
  std::vector<Twist> of_driven = group_.loads;
  for (std::size_t i = 0; i < of_driven.size(); ++i) {
    if (moves(group_.bodies[i])) {
      of_driven[i] = {};
    }
  }
  const auto n = static_cast<Index>(all.size());
  Constraints c{MatrixXd(n, unknowns_), VectorXd(n), VectorXd(n)};
  for (Index k = 0; k < n; ++k) {
    const auto& [touch, d] = all[static_cast<std::size_t>(k)];
    const FrictionTouch& t = touches_[touch];
    const bool along = d != t.n;
    c.rows.row(k) = row(t, d);
    const Vector3 v = relative(t, velocities);
    c.rates[k] = d.dot(along ? Vector3(v + group_.patches[t.patch].drift) : v);
    c.driven[k] = d.dot(relative(t, of_driven));
  }
  return c;
}

Twist FrictionForces::scaled(std::size_t i, const VectorXd& z) const {
  const GroupBody& body = group_.bodies[i];
  Twist out;
  if (moves(body)) {
    out.linear = std::sqrt(body.inverse_mass / unit_) * z.segment<3>(first_[i]);
    if (turns(i)) {
      out.angular = std::sqrt(body.inverse_inertia(0, 0) / unit_) * z.segment<3>(first_[i] + 3);
    }
  }
  return out;
}

/// Directions in which the points of a touch may be pushed.
std::vector<Vector3> FrictionForces::rays(const FrictionTouch& t, const FrictionChoice& c) const {
  if (c.does == Does::slides || c.does == Does::begins) {
    return {t.mu > 0.0 && !c.direction.isZero(0.0) ? Vector3(t.n - t.mu * c.direction) : t.n};
  }
  if (std::isinf(t.mu)) {
    return {t.n, t.t1, -t.t1, t.t2, -t.t2};
  }
  std::vector<Vector3> out;
  for (int k = 0; k < rays_of_cone; ++k) {
    const double angle = 2.0 * M_PI * k / rays_of_cone;
    // Rays along an axis are so exactly.
    const double c1 = k % 4 == 0 ? (k == 0 ? 1.0 : k == 8 ? -1.0 : 0.0) : cosine(angle);
    const double c2 = k % 4 == 0 ? (k == 4 ? 1.0 : k == 12 ? -1.0 : 0.0) : sine(angle);
    out.emplace_back(t.n + t.mu * (c1 * t.t1 + c2 * t.t2));
  }
  return out;
}

std::optional<FrictionForces::Solution> FrictionForces::solve(
    const std::vector<FrictionChoice>& choices) {
  for (std::size_t k = 0; k < choices.size(); ++k) {
    const bool slides = choices[k].does == Does::slides || choices[k].does == Does::begins;
    if (slides && std::isinf(touches_[k].mu)) {
      return std::nullopt;  // without a bound of friction nothing slides
    }
  }
  for (int round = 0; round < 3; ++round) {
    std::optional<Solution> found = solve_once(choices);
    if (found || !realign(choices)) {
      return found;
    }
  }
  return std::nullopt;
}

/// Turns the rays of the cones towards the forces that came nearest; false if they are there
/// already.
bool FrictionForces::realign(const std::vector<FrictionChoice>& choices) {
  bool turned = false;
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    FrictionTouch& t = touches_[k];
    const Vector3 f = nearest_[k] - t.n * t.n.dot(nearest_[k]);
    if (choices[k].does == Does::sticks && f.norm() > 0.0 &&
        f.cross(t.t1).norm() > 1e-12 * f.norm()) {
      align(t, f);
      turned = true;
    }
  }
  return turned;
}

/// Accelerations that the constraints allow; nothing if they contradict each other.
std::optional<FrictionForces::Allowed> FrictionForces::allowed(
    const std::vector<FrictionChoice>& choices) const {
  const Constraints held = constraints(choices, group_.velocities);
  Allowed allowed{VectorXd::Zero(unknowns_), MatrixXd::Identity(unknowns_, unknowns_)};
  if (held.rows.rows() == 0 || unknowns_ == 0) {
    return allowed;
  }
  allowed.start = LeastNorm(held.rows).solve(-held.driven);
  if ((held.rows * allowed.start + held.driven).lpNorm<Eigen::Infinity>() >
      solve_roundoff * load_) {
    return std::nullopt;
  }
  allowed.free = null_space(held.rows);
  return allowed;
}

std::vector<FrictionForces::Push> FrictionForces::pushes(
    const std::vector<FrictionChoice>& choices) const {
  std::vector<Push> pushes;
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    if (choices[k].does == Does::opens) {
      continue;
    }
    const FrictionTouch& t = touches_[k];
    const ContactManifold& m = group_.patches[t.patch].manifold;
    for (const Vector3& direction : rays(t, choices[k])) {
      for (std::size_t j = 0; j < m.size; ++j) {
        Push push{k, direction, VectorXd::Zero(balances_)};
        for (const auto& [i, sign] : sides(t)) {
          const GroupBody& body = group_.bodies[i];
          if (!moves(body)) {
            continue;
          }
          push.column.segment<3>(balance_[i]) = sign * body.inverse_mass * direction;
          if (can_turn(i)) {
            const Vector3 lever = arm(t, i, m.points[j].position);
            push.column.segment<3>(balance_[i] + 3) =
                sign * group_.radius[i] * (body.inverse_inertia * lever.cross(direction));
          }
        }
        pushes.push_back(std::move(push));
      }
    }
  }
  return pushes;
}

/// The unknowns are z of the allowed accelerations, of any sign, and how hard each ray pushes.
std::optional<FrictionForces::Solution> FrictionForces::solve_once(
    const std::vector<FrictionChoice>& choices) {
  const std::optional<Allowed> motion = allowed(choices);
  if (!motion) {
    return std::nullopt;
  }
  const std::vector<Push> by_ray = pushes(choices);
  const Index n = motion->free.cols();
  MatrixXd A(balances_, n + static_cast<Index>(by_ray.size()));
  VectorXd b(balances_);
  for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
    if (!moves(group_.bodies[i])) {
      continue;
    }
    const Twist start = scaled(i, motion->start);
    const double r = group_.radius[i];
    b.segment<3>(balance_[i]) = start.linear - group_.loads[i].linear;
    if (can_turn(i)) {
      b.segment<3>(balance_[i] + 3) = r * (start.angular - group_.loads[i].angular);
    }
    for (Index k = 0; k < n; ++k) {
      const Twist along = scaled(i, motion->free.col(k));
      A.block<3, 1>(balance_[i], k) = -along.linear;
      if (can_turn(i)) {
        A.block<3, 1>(balance_[i] + 3, k) = -r * along.angular;
      }
    }
  }
  VectorXd length = VectorXd::Ones(A.cols());
  for (std::size_t k = 0; k < by_ray.size(); ++k) {
    const Index column = n + static_cast<Index>(k);
    length[column] = std::max(by_ray[k].column.norm(), 1e-300);
    A.col(column) = by_ray[k].column / length[column];
  }
  const NonnegativeSolution answer = solve_nonnegative(A, b, n);
  solves_ += answer.solves;
  Solution found;
  found.choices = choices;
  found.force.assign(touches_.size(), Vector3::Zero());
  for (std::size_t k = 0; k < by_ray.size(); ++k) {
    const Index column = n + static_cast<Index>(k);
    found.force[by_ray[k].touch] += answer.x[column] / length[column] * by_ray[k].direction;
  }
  nearest_ = found.force;
  if (answer.residual > solve_roundoff * load_) {
    return std::nullopt;
  }
  const VectorXd z = motion->start + motion->free * answer.x.head(n);
  found.accelerations = group_.loads;
  for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
    if (moves(group_.bodies[i])) {
      found.accelerations[i] = scaled(i, z);
    }
  }
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    const FrictionTouch& t = touches_[k];
    if (choices[k].does == Does::opens &&
        t.n.dot(relative(t, found.accelerations)) < -solve_roundoff * load_) {
      return std::nullopt;
    }
  }
  return found;
}

void FrictionForces::slow_down(const std::vector<FrictionChoice>& choices,
                               std::vector<Twist>& velocities) const {
  for (int round = 0; round < 2 && unknowns_ > 0; ++round) {
    const Constraints held = constraints(choices, velocities);
    if (held.rates.isZero(0.0)) {
      return;
    }
    const VectorXd z = LeastNorm(held.rows).solve(-held.rates);
    for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
      const Twist change = scaled(i, z);
      velocities[i].linear += change.linear;
      velocities[i].angular += change.angular;
    }
  }
}

}  // namespace core
}  // namespace kairos
