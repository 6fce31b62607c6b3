#include "core/laws/routh_law.hpp"

#include "core/contacts/routh_impact.hpp"

#include <array>
#include <limits>
#include <tuple>

namespace kairos {
inline namespace core {
namespace {

/// A body as the contact feels it: velocities along the axes of the contact, and what impulses
/// along them do.
struct Side {
  Side(const ImpactBody& body, const Contact& contact, const Matrix3& axes, double sign)
      : free(body.inertia.mass > 0.0),
        turns(free && body.inertia.rotates),
        mass(body.inertia.mass),
        principal(body.inertia.principal),
        principal_axes(body.inertia.principal_axes(body.state.pose.orientation)) {
    const Vector3& origin = body.state.pose.position;
    Vector3 arm = contact.point - origin;
    if (const auto* sphere = std::get_if<Sphere>(&body.body.shape);
        sphere != nullptr && body.body.bounds == Bounds::shape) {
      arm = sign * sphere->radius * contact.normal;  // of the point that touches
    }
    // Levers that the coordinates cannot tell from none turn nothing.
    const double unresolved = 512.0 * std::numeric_limits<double>::epsilon() *
                              (arm.lpNorm<1>() + origin.lpNorm<Eigen::Infinity>());
    for (int k = 0; k < 3; ++k) {
      const Vector3 lever = principal_axes.conjugate() * Vector3(arm.cross(axes.col(k)));
      for (int axis = 0; axis < 3; ++axis) {
        levers(axis, k) = std::abs(lever[axis]) <= unresolved ? 0.0 : lever[axis];
      }
    }
    const Twist& twist = body.state.twist;
    velocity = axes.transpose() * twist.linear +
               levers.transpose() * (principal_axes.conjugate() * twist.angular);
    if (!free && !twist.angular.isZero(0.0)) {
      velocity = axes.transpose() * (twist.linear + twist.angular.cross(arm));
    }
    belt = axes.transpose() * body.body.entity->surface_velocity(body.body, body.state);
    belt[0] = 0.0;
  }

  [[nodiscard]] Matrix3 compliance() const {
    Matrix3 W = Matrix3::Zero();
    if (free) {
      W.diagonal().setConstant(1.0 / mass);
    }
    if (turns) {
      W += levers.transpose() * principal.cwiseInverse().asDiagonal() * levers;
    }
    return W;
  }

  void push(Twist& twist, const Vector3& impulse, const Matrix3& axes) const {
    if (free) {
      twist.linear += axes * impulse / mass;
    }
    if (turns) {
      twist.angular += principal_axes * Vector3((levers * impulse).cwiseQuotient(principal));
    }
  }

  bool free;
  bool turns;
  double mass;
  Vector3 principal;
  Quaternion principal_axes;  ///< in the world
  Matrix3 levers;             ///< r x axis, along the principal axes, by column
  Vector3 velocity;           ///< of the point that touches
  Vector3 belt;               ///< of its surface beside that
};

/// Normal first, then where it slides.
Matrix3 contact_axes(const Vector3& n, const Vector3& slip) {
  Matrix3 axes;
  axes.col(0) = n;
  Vector3 t = slip - n * n.dot(slip);
  if (t.norm() < 0.1 * slip.norm()) {
    t -= n * n.dot(t);  // what cancelled is not across n yet: twice is enough [Parlett1980]
  }
  const double length = t.norm();
  axes.col(1) =
      length > 1e-12 * slip.norm() && length > 0.0 ? Vector3(t / length) : n.unitOrthogonal();
  axes.col(2) = n.cross(axes.col(1));
  return axes;
}

class RouthLaw final : public ImpactLaw {
 public:
  [[nodiscard]] LawInfo info() const override {
    return {.name = "routh",
            .needs_contact = true,
            .summary =
                "friction and Stronge's restitution, as a motion in the normal impulse: "
                "keeps momentum; normal work (1 - e^2) of that of the approach, friction "
                "takes energy; without friction newton",
            .friction = true,
            .kinematic = false};
  }
  ImpactEnergy apply(const Contact& contact, ImpactBody a, ImpactBody b) const override {
    return apply_routh(contact, a, b);
  }
};

}  // namespace

ImpactEnergy apply_routh(const Contact& contact, ImpactBody a, ImpactBody b) {
  const Vector3& n = contact.normal;
  Matrix3 axes = contact_axes(n, n);
  Side of_a(a, contact, axes, 1.0);
  Side of_b(b, contact, axes, -1.0);
  const auto slips = [&] {
    return Vector3((of_b.velocity + of_b.belt) - (of_a.velocity + of_a.belt));
  };
  axes = contact_axes(n, axes * slips());
  of_a = Side(a, contact, axes, 1.0);
  of_b = Side(b, contact, axes, -1.0);
  const Vector3 before = slips();
  const Matrix3 W = of_a.compliance() + of_b.compliance();
  ImpactEnergy energy;
  if (before[0] >= 0.0 || !(W(0, 0) > 0.0)) {
    return energy;
  }
  const RouthImpact impact = routh_impact(W, before, contact.friction, contact.restitution);
  if (!impact.solved) {
    return energy;  // they go on approaching, which the run tells
  }
  const Vector3& p = impact.impulse;
  energy.restitution_loss = impact.normal_work;
  energy.impact_friction = impact.friction_work;
  for (const auto& [body, side, sign] : {std::tuple{&a, &of_a, -1.0}, std::tuple{&b, &of_b, 1.0}}) {
    energy.conveyor_and_hand -= sign * p.dot(side->belt);
    if (body->body.drive != nullptr) {
      energy.driven_work -= sign * p.dot(side->velocity);
    }
  }
  of_a.push(a.state.twist, -p, axes);
  of_b.push(b.state.twist, p, axes);
  return energy;
}

std::unique_ptr<ImpactLaw> make_routh_law() { return std::make_unique<RouthLaw>(); }

}  // namespace core
}  // namespace kairos
