#include "core/laws/garwin_law.hpp"

#include "core/laws/contact_sides.hpp"
#include "core/laws/routh_law.hpp"

namespace kairos {
inline namespace core {
namespace {

class GarwinLaw final : public ImpactLaw {
 public:
  [[nodiscard]] LawInfo info() const override {
    return {.name = "garwin",
            .needs_contact = true,
            .summary =
                "a superball: where friction can hold it, velocities along the surface are "
                "reversed, too: keeps momentum, and energy at e = 1; elsewhere routh",
            .friction = true,
            .kinematic = false};
  }

  ImpactEnergy apply(const Contact& contact, ImpactBody a, ImpactBody b) const override {
    const ContactSides sides(contact, a, b);
    const Vector3 before = sides.slip();
    const Matrix3 W = sides.compliance();
    ImpactEnergy energy;
    if (before[0] >= 0.0 || !(W(0, 0) > 0.0)) {
      return energy;
    }
    const double e = contact.restitution;
    // Bodies that do not turn feel no impulse across: a column of W is never without its diagonal.
    Vector3 impulse = W.ldlt().solve(Vector3(-2.0 * before));
    impulse[0] += (1.0 - e) * before[0] / W(0, 0);
    const double across = impulse.tail<2>().norm();
    if (!(impulse[0] > 0.0 && across <= contact.friction * impulse[0])) {
      return apply_routh(contact, a, b);
    }
    energy.restitution_loss = 0.5 * (e * e - 1.0) * before[0] * before[0] / W(0, 0);
    sides.push(impulse, a, b, energy);
    return energy;
  }
};

}  // namespace

std::unique_ptr<ImpactLaw> make_garwin_law() { return std::make_unique<GarwinLaw>(); }

}  // namespace core
}  // namespace kairos
