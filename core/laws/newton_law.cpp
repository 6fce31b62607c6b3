#include "core/laws/newton_law.hpp"

#include "core/contacts/group_impacts.hpp"
#include "core/contacts/group_law.hpp"
#include "core/laws/routh_law.hpp"
#include "core/point_law.hpp"

#include <limits>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

bool is_free(const ImpactBody& body) { return body.inertia.mass > 0.0; }

/// What the arm from an origin to a contact may be off by, m, as much as a contact patch takes for
/// level: 1024 roundings of the coordinates that it was put together from, which were rotated,
/// clipped, and reached by a flight whose direction was rounded.
double arm_roundoff(const Vector3& point, const Vector3& origin) {
  const double arm = (point - origin).lpNorm<1>();
  return 512.0 * std::numeric_limits<double>::epsilon() * (arm + origin.lpNorm<Eigen::Infinity>());
}

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
        axes(body.inertia.principal_axes(state.pose.orientation).template cast<Real>()),
        arm(contact.point.template cast<Real>() - state.pose.position.template cast<Real>()),
        unresolved(arm_roundoff(contact.point, state.pose.position)),
        v(state.twist.linear.template cast<Real>()),
        w(state.twist.angular.template cast<Real>()) {}

  [[nodiscard]] Vector at_contact() const { return v + w.cross(arm); }

  /// r x p along the principal axes, in two parts. What the coordinates cannot
  /// tell from none is `unfelt`: it turns nothing, so that a symmetric patch does not.
  struct Moment {
    Vector felt;
    Vector unfelt = Vector::Zero();
  };
  [[nodiscard]] Moment moment(const Vector& p) const {
    Moment m{axes.conjugate() * Vector(arm.cross(p))};
    const Real none = unresolved * p.norm();
    for (int k = 0; k < 3; ++k) {
      if (m.felt[k] <= none && m.felt[k] >= -none) {
        std::swap(m.felt[k], m.unfelt[k]);
      }
    }
    return m;
  }

  /// I_W^-1 (r x p); 0 for a body that does not turn.
  [[nodiscard]] Vector turned_by(const Vector& p) const {
    if (!turns) {
      return Vector::Zero();
    }
    return axes * Vector(moment(p).felt.cwiseQuotient(principal));
  }

  /// The part of the contact's velocity along n that is rotation about levers that are not felt.
  [[nodiscard]] Real unfelt(const Vector& n) const {
    return turns ? moment(n).unfelt.dot(Vector(axes.conjugate() * w)) : Real(0);
  }

  /// n^T K n, K the inverse inertia that the contact point feels: 1/m + n.((I^-1 (r x n)) x r).
  [[nodiscard]] Real compliance(const Vector& n) const {
    return free ? Real(1) / mass + n.dot(turned_by(n).cross(arm)) : Real(0);
  }

  void push(const Vector& impulse) {
    if (free) {
      v += impulse / mass;
      w += turned_by(impulse);
    }
  }

  bool free;
  bool turns;
  Real mass;
  Vector principal;
  Eigen::Quaternion<Real> axes;  ///< principal, in the world
  Vector arm;                    ///< from the origin to the contact
  double unresolved;             ///< what its coordinates may be off by, m
  Vector v;
  Vector w;
};

/// The same of a body that does not turn.
struct PointSide {
  using Vector = Vector3;

  explicit PointSide(const StruckPoint& point) : mass(point.mass), v(point.velocity) {}

  [[nodiscard]] const Vector3& at_contact() const { return v; }
  [[nodiscard]] static double unfelt(const Vector3& /*n*/) { return 0.0; }
  [[nodiscard]] double compliance(const Vector3& /*n*/) const { return 1.0 / mass; }
  void push(const Vector3& impulse) { v += impulse / mass; }

  double mass;
  Vector3& v;
};

/// The impulse on b along n, after restitution e; `loss`: of energy, <= 0.
template <typename OneSide, typename Real>
typename OneSide::Vector collide(OneSide& a, OneSide& b, const typename OneSide::Vector& n, Real e,
                                 Real& loss) {
  const Real approach = n.dot(b.at_contact() - a.at_contact()) - (b.unfelt(n) - a.unfelt(n));
  const Real inverse_mass = a.compliance(n) + b.compliance(n);
  if (approach >= 0 || inverse_mass <= 0) {
    return OneSide::Vector::Zero();
  }
  loss = Real(0.5) * (e * e - 1) * approach * approach / inverse_mass;
  const typename OneSide::Vector impulse = (-(1 + e) * approach / inverse_mass) * n;
  a.push(-impulse);
  b.push(impulse);
  return impulse;
}

/// Work of a driven body on the other: impulse on the other times its own material velocity.
double driven_work(const ImpactBody& driver, const Side<double>& side, const Vector3& impulse) {
  return driver.body.drive == nullptr ? 0.0 : impulse.dot(side.at_contact());
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
    const Vector w = exact.axes.conjugate() * Vector(computed.twist.angular.cast<long double>());
    const Vector dw = w - exact.axes.conjugate() * exact.w;
    energy += exact.principal.cwiseProduct(w - 0.5L * dw).dot(dw);
  }
  return static_cast<double>(energy);
}

class NewtonLaw final : public ImpactLaw, public GroupLaw, public PointLaw {
 public:
  /// Bodies that merely touch are struck one pair after the other; what is held together takes an
  /// impact as one, for its contacts have no velocity of which a part could be returned.
  [[nodiscard]] bool takes_what_touches() const override { return false; }
  [[nodiscard]] Eigen::VectorXd strike(const ContactSystem& system,
                                       const Eigen::VectorXd& restitution,
                                       std::vector<Twist>& v) const override {
    return newton_group(system, restitution, v);
  }

  [[nodiscard]] LawInfo info() const override {
    return {.name = "newton",
            .needs_contact = true,
            .summary =
                "restitution at the contact point, with rotation; with friction what "
                "'routh' does",
            .passed_on_by_joints = true,
            .friction = true};
  }

  ImpactEnergy apply(const Contact& contact, ImpactBody a, ImpactBody b) const override {
    if (contact.friction > 0.0) {
      return apply_routh(contact, a, b);  // with friction Newton's e could create energy
    }
    ImpactEnergy energy;
    Side<double> of_a(a, a.state, contact);
    Side<double> of_b(b, b.state, contact);
    const double e = contact.restitution;
    const Vector3 impulse = collide(of_a, of_b, contact.normal, e, energy.restitution_loss);
    if (impulse.isZero(0.0)) {
      return energy;
    }
    // A driven body keeps its velocity.
    energy.driven_work = driven_work(a, of_a, impulse) + driven_work(b, of_b, -impulse);
    a.state.twist = {of_a.v, of_a.w};
    b.state.twist = {of_b.v, of_b.w};
    return energy;
  }

  [[nodiscard]] ImpactEnergy apply_to_points(const Contact& contact, const StruckPoint& a,
                                             const StruckPoint& b) const override {
    ImpactEnergy energy;
    PointSide of_a(a);
    PointSide of_b(b);
    (void)collide(of_a, of_b, contact.normal, contact.restitution, energy.restitution_loss);
    return energy;
  }

  double roundoff(const Contact& contact, const ImpactBody& a, const ImpactBody& b,
                  const BodyState& before_a, const BodyState& before_b) const override {
    if (contact.friction > 0.0) {
      return 0.0;
    }
    Side<long double> of_a(a, before_a, contact);
    Side<long double> of_b(b, before_b, contact);
    // Of the exact law, which knows unit vectors.
    of_a.axes.normalize();
    of_b.axes.normalize();
    const auto n = contact.normal.cast<long double>().normalized().eval();
    const auto e = static_cast<long double>(contact.restitution);
    long double loss = 0.0L;
    if (collide(of_a, of_b, n, e, loss).isZero(0.0L)) {
      return 0.0;
    }
    return surplus(a.state, of_a) + surplus(b.state, of_b);
  }
};

}  // namespace

std::unique_ptr<ImpactLaw> make_newton_law() { return std::make_unique<NewtonLaw>(); }

}  // namespace core
}  // namespace kairos
