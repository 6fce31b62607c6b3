#include "core/laws/newton_law.hpp"

namespace kairos {
inline namespace core {
namespace {

bool is_free(const ImpactBody& body) { return body.inertia.mass > 0.0; }

/// I_W^-1 x, through the principal axes; 0 for a body that does not turn.
Vector3 inverse_inertia(const ImpactBody& body, const Vector3& x) {
  if (!is_free(body) || !body.inertia.rotates) {
    return Vector3::Zero();
  }
  const Quaternion& q = body.state.pose.orientation;
  const Vector3 x_B = q.conjugate() * x;
  return q * Vector3(x_B.cwiseQuotient(body.inertia.principal));
}

/// n^T K n, K the inverse inertia that the contact point feels: 1/m + n.((I^-1 (r x n)) x r).
double compliance(const ImpactBody& body, const Contact& contact) {
  if (!is_free(body)) {
    return 0.0;
  }
  const Vector3 arm = contact.point - body.state.pose.position;
  const Vector3 turned = inverse_inertia(body, arm.cross(contact.normal)).cross(arm);
  return 1.0 / body.inertia.mass + contact.normal.dot(turned);
}

void push(const ImpactBody& body, const Contact& contact, const Vector3& impulse) {
  if (!is_free(body)) {
    return;
  }
  const Vector3 arm = contact.point - body.state.pose.position;
  body.state.twist.linear += impulse / body.inertia.mass;
  body.state.twist.angular += inverse_inertia(body, arm.cross(impulse));
}

/// Work of a driven body on the other: impulse on the other times its own material velocity.
double driven_work(const ImpactBody& driver, const Contact& contact, const Vector3& impulse) {
  if (driver.body.drive == nullptr) {
    return 0.0;
  }
  return impulse.dot(driver.state.twist.at(contact.point, driver.state.pose.position));
}

/// The belt under `carried` exchanges momentum with its motion along the belt.
double carry(const ImpactBody& conveyor, const ImpactBody& carried) {
  const Momentum belt = conveyor.body.entity->belt(conveyor.body, conveyor.state);
  const double speed = belt.velocity.norm();
  if (belt.mass <= 0.0 || speed == 0.0 || !is_free(carried)) {
    return 0.0;
  }
  const Vector3 along = belt.velocity / speed;
  const double m = carried.inertia.mass;
  const double u = along.dot(carried.state.twist.linear);
  const double impulse = 2.0 * m * belt.mass / (m + belt.mass) * (speed - u);
  carried.state.twist.linear += along * (impulse / m);
  return impulse * (m * u + belt.mass * speed) / (m + belt.mass);
}

class NewtonLaw final : public ImpactLaw {
 public:
  [[nodiscard]] LawInfo info() const override {
    return {"newton", true, "restitution at the contact point, with rotation, without friction"};
  }

  ImpactEnergy apply(const Contact& contact, ImpactBody a, ImpactBody b) const override {
    ImpactEnergy energy;
    const double approach = normal_velocity(contact, a.state, b.state);
    const double inverse_mass = compliance(a, contact) + compliance(b, contact);
    if (approach >= 0.0 || inverse_mass <= 0.0) {
      return energy;
    }
    const double e = a.body.restitution * b.body.restitution;
    const Vector3 impulse = (-(1.0 + e) * approach / inverse_mass) * contact.normal;
    energy.restitution_loss = 0.5 * (e * e - 1.0) * approach * approach / inverse_mass;
    energy.driven_work = driven_work(a, contact, impulse) + driven_work(b, contact, -impulse);
    push(a, contact, -impulse);
    push(b, contact, impulse);
    energy.conveyor_and_hand = carry(a, b) + carry(b, a);
    return energy;
  }
};

}  // namespace

std::unique_ptr<ImpactLaw> make_newton_law() { return std::make_unique<NewtonLaw>(); }

}  // namespace core
}  // namespace kairos
