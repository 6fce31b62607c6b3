#include "core/laws/newton_law.hpp"

namespace kairos {
inline namespace core {
namespace {

bool is_free(const ImpactBody& body) { return body.inertia.mass > 0.0; }

/// A body as the law computes with it, written once for `double`, which is what acts, and for
/// `long double`, which tells what rounding did.
template <typename Real>
struct Side {
  using Vector = Eigen::Matrix<Real, 3, 1, Eigen::DontAlign>;

  Side(const ImpactBody& body, const BodyState& state, const Contact& contact)
      : free(is_free(body)),
        turns(free && body.inertia.rotates),
        mass(body.inertia.mass),
        principal(body.inertia.principal.template cast<Real>()),
        orientation(state.pose.orientation.template cast<Real>()),
        arm(contact.point.template cast<Real>() - state.pose.position.template cast<Real>()),
        v(state.twist.linear.template cast<Real>()),
        w(state.twist.angular.template cast<Real>()) {}

  [[nodiscard]] Vector at_contact() const { return v + w.cross(arm); }

  /// I_W^-1 x, through the principal axes; 0 for a body that does not turn.
  [[nodiscard]] Vector inverse_inertia(const Vector& x) const {
    if (!turns) {
      return Vector::Zero();
    }
    const Vector x_B = orientation.conjugate() * x;
    return orientation * Vector(x_B.cwiseQuotient(principal));
  }

  /// n^T K n, K the inverse inertia that the contact point feels: 1/m + n.((I^-1 (r x n)) x r).
  [[nodiscard]] Real compliance(const Vector& n) const {
    return free ? Real(1) / mass + n.dot(inverse_inertia(arm.cross(n)).cross(arm)) : Real(0);
  }

  void push(const Vector& impulse) {
    if (free) {
      v += impulse / mass;
      w += inverse_inertia(arm.cross(impulse));
    }
  }

  bool free;
  bool turns;
  Real mass;
  Vector principal;
  Eigen::Quaternion<Real> orientation;
  Vector arm;  ///< from the origin to the contact
  Vector v;
  Vector w;
};

/// The impulse on b along n, after restitution e; `loss`: of energy, <= 0.
template <typename Real>
typename Side<Real>::Vector collide(Side<Real>& a, Side<Real>& b,
                                    const typename Side<Real>::Vector& n, Real e, Real& loss) {
  const Real approach = n.dot(b.at_contact() - a.at_contact());
  const Real inverse_mass = a.compliance(n) + b.compliance(n);
  if (approach >= 0 || inverse_mass <= 0) {
    return Side<Real>::Vector::Zero();
  }
  loss = Real(0.5) * (e * e - 1) * approach * approach / inverse_mass;
  const typename Side<Real>::Vector impulse = (-(1 + e) * approach / inverse_mass) * n;
  a.push(-impulse);
  b.push(impulse);
  return impulse;
}

/// Work of a driven body on the other: impulse on the other times its own material velocity.
double driven_work(const ImpactBody& driver, const Side<double>& side, const Vector3& impulse) {
  return driver.body.drive == nullptr ? 0.0 : impulse.dot(side.at_contact());
}

/// The belt under `carried` exchanges momentum with its motion along the belt.
template <typename Real>
Real carry(const ImpactBody& conveyor, const BodyState& belt_state, Side<Real>& carried) {
  const Momentum belt = conveyor.body.entity->belt(conveyor.body, belt_state);
  const Real speed = belt.velocity.template cast<Real>().norm();
  if (belt.mass <= 0.0 || speed == 0 || !carried.free) {
    return 0;
  }
  const typename Side<Real>::Vector along = belt.velocity.template cast<Real>() / speed;
  const Real m = carried.mass;
  const Real u = along.dot(carried.v);
  const Real impulse = 2 * m * belt.mass / (m + belt.mass) * (speed - u);
  carried.v += along * (impulse / m);
  return impulse * (m * u + belt.mass * speed) / (m + belt.mass);
}

/// Kinetic energy of the body as computed minus that of its exact side, J.
double surplus(const BodyState& computed, const Side<long double>& exact) {
  if (!exact.free) {
    return 0.0;
  }
  using Vector = Side<long double>::Vector;
  const Vector v = computed.twist.linear.cast<long double>();
  const Vector dv = v - exact.v;
  long double energy = exact.mass * (v - 0.5L * dv).dot(dv);
  if (exact.turns) {
    const Vector w =
        exact.orientation.conjugate() * Vector(computed.twist.angular.cast<long double>());
    const Vector dw = w - exact.orientation.conjugate() * exact.w;
    energy += exact.principal.cwiseProduct(w - 0.5L * dw).dot(dw);
  }
  return static_cast<double>(energy);
}

class NewtonLaw final : public ImpactLaw {
 public:
  [[nodiscard]] LawInfo info() const override {
    return {"newton", true, "restitution at the contact point, with rotation, without friction"};
  }

  ImpactEnergy apply(const Contact& contact, ImpactBody a, ImpactBody b) const override {
    ImpactEnergy energy;
    Side<double> of_a(a, a.state, contact);
    Side<double> of_b(b, b.state, contact);
    const double e = a.body.restitution * b.body.restitution;
    const Vector3 impulse = collide<double>(of_a, of_b, contact.normal, e, energy.restitution_loss);
    if (impulse.isZero(0.0)) {
      return energy;
    }
    // A driven body keeps its velocity.
    energy.driven_work = driven_work(a, of_a, impulse) + driven_work(b, of_b, -impulse);
    energy.conveyor_and_hand = carry(a, a.state, of_b) + carry(b, b.state, of_a);
    a.state.twist = {of_a.v, of_a.w};
    b.state.twist = {of_b.v, of_b.w};
    return energy;
  }

  double roundoff(const Contact& contact, const ImpactBody& a, const ImpactBody& b,
                  const BodyState& before_a, const BodyState& before_b) const override {
    Side<long double> of_a(a, before_a, contact);
    Side<long double> of_b(b, before_b, contact);
    // Of the exact law, which knows unit vectors.
    of_a.orientation.normalize();
    of_b.orientation.normalize();
    const auto n = contact.normal.cast<long double>().normalized().eval();
    const auto e = static_cast<long double>(a.body.restitution) * b.body.restitution;
    long double loss = 0.0L;
    if (collide<long double>(of_a, of_b, n, e, loss).isZero(0.0L)) {
      return 0.0;
    }
    carry(a, before_a, of_b);
    carry(b, before_b, of_a);
    return surplus(a.state, of_a) + surplus(b.state, of_b);
  }
};

}  // namespace

std::unique_ptr<ImpactLaw> make_newton_law() { return std::make_unique<NewtonLaw>(); }

}  // namespace core
}  // namespace kairos
