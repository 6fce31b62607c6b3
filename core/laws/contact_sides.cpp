#include "core/laws/contact_sides.hpp"

#include <limits>
#include <tuple>

namespace kairos {
inline namespace core {

ContactSide::ContactSide(const ImpactBody& body, const Contact& contact, const Matrix3& axes,
                         double sign)
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

Matrix3 ContactSide::compliance() const {
  Matrix3 W = Matrix3::Zero();
  if (free) {
    W.diagonal().setConstant(1.0 / mass);
  }
  if (turns) {
    W += levers.transpose() * principal.cwiseInverse().asDiagonal() * levers;
  }
  return W;
}

void ContactSide::push(Twist& twist, const Vector3& impulse, const Matrix3& axes) const {
  if (free) {
    twist.linear += axes * impulse / mass;
  }
  if (turns) {
    twist.angular += principal_axes * Vector3((levers * impulse).cwiseQuotient(principal));
  }
}

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

ContactSides::ContactSides(const Contact& contact, const ImpactBody& of_a, const ImpactBody& of_b)
    : axes(contact_axes(contact.normal, contact.normal)),
      a(of_a, contact, axes, 1.0),
      b(of_b, contact, axes, -1.0) {
  axes = contact_axes(contact.normal, axes * slip());
  a = ContactSide(of_a, contact, axes, 1.0);
  b = ContactSide(of_b, contact, axes, -1.0);
}

void ContactSides::push(const Vector3& impulse, ImpactBody& of_a, ImpactBody& of_b,
                        ImpactEnergy& energy) const {
  for (const auto& [body, side, sign] : {std::tuple{&of_a, &a, -1.0}, std::tuple{&of_b, &b, 1.0}}) {
    energy.conveyor_and_hand -= sign * impulse.dot(side->belt);
    if (body->body.drive != nullptr) {
      energy.driven_work -= sign * impulse.dot(side->velocity);
    }
  }
  a.push(of_a.state.twist, -impulse, axes);
  b.push(of_b.state.twist, impulse, axes);
}

}  // namespace core
}  // namespace kairos
