#include "core/laws/routh_law.hpp"

#include "core/contacts/routh_impact.hpp"
#include "core/laws/contact_sides.hpp"

namespace kairos {
inline namespace core {
namespace {

class RouthLaw final : public ImpactLaw {
 public:
  [[nodiscard]] LawInfo info() const override {
    return {.name = "routh",
            .needs_contact = true,
            .summary =
                "friction and Stronge's restitution, as a motion in the normal impulse: "
                "keeps momentum; normal work (1 - e^2) of that of the approach, friction "
                "takes energy; without friction newton",
            .passed_on_by_joints = true,
            .friction = true,
            .kinematic = false};
  }
  ImpactEnergy apply(const Contact& contact, ImpactBody a, ImpactBody b) const override {
    return apply_routh(contact, a, b);
  }
};

}  // namespace

ImpactEnergy apply_routh(const Contact& contact, ImpactBody a, ImpactBody b) {
  const ContactSides sides(contact, a, b);
  const Vector3 before = sides.slip();
  const Matrix3 W = sides.compliance();
  ImpactEnergy energy;
  if (before[0] >= 0.0 || !(W(0, 0) > 0.0)) {
    return energy;
  }
  const RouthImpact impact = routh_impact(W, before, contact.friction, contact.restitution);
  if (!impact.solved) {
    return energy;  // they go on approaching, which the run tells
  }
  energy.restitution_loss = impact.normal_work;
  energy.impact_friction = impact.friction_work;
  sides.push(impact.impulse, a, b, energy);
  return energy;
}

std::unique_ptr<ImpactLaw> make_routh_law() { return std::make_unique<RouthLaw>(); }

}  // namespace core
}  // namespace kairos
