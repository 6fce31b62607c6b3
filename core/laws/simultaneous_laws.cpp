#include "core/laws/simultaneous_laws.hpp"

#include "core/contacts/group_impacts.hpp"
#include "core/contacts/group_law.hpp"
#include "core/laws/newton_law.hpp"

namespace kairos {
inline namespace core {
namespace {

using GroupImpact = Eigen::VectorXd (*)(const ContactSystem&, const Eigen::VectorXd&,
                                        std::vector<Twist>&);

/// Between two bodies Newton's law; what it does to several is told by a function.
class SimultaneousLaw final : public ImpactLaw, public GroupLaw {
 public:
  SimultaneousLaw(LawInfo info, GroupImpact impact)
      : info_(info), impact_(impact), of_pair_(make_newton_law()) {}

  [[nodiscard]] LawInfo info() const override { return info_; }
  ImpactEnergy apply(const Contact& contact, ImpactBody a, ImpactBody b) const override {
    return of_pair_->apply(contact, a, b);
  }
  double roundoff(const Contact& contact, const ImpactBody& a, const ImpactBody& b,
                  const BodyState& before_a, const BodyState& before_b) const override {
    return of_pair_->roundoff(contact, a, b, before_a, before_b);
  }
  [[nodiscard]] bool takes_what_touches() const override { return true; }
  [[nodiscard]] Eigen::VectorXd strike(const ContactSystem& system,
                                       const Eigen::VectorXd& restitution,
                                       std::vector<Twist>& v) const override {
    return impact_(system, restitution, v);
  }

 private:
  LawInfo info_;
  GroupImpact impact_;
  std::unique_ptr<ImpactLaw> of_pair_;
};

}  // namespace

std::unique_ptr<ImpactLaw> make_moreau_law() {
  return std::make_unique<SimultaneousLaw>(
      LawInfo{"moreau", true,
              "restitution of all contacts of touching bodies at once, without friction: keeps "
              "momentum and symmetry, never gains energy",
              true},
      newton_group);
}

std::unique_ptr<ImpactLaw> make_reflections_law() {
  return std::make_unique<SimultaneousLaw>(
      LawInfo{"reflections", true,
              "impacts of touching bodies as reflections in turn, without friction: keeps "
              "momentum, symmetry, and energy at e = 1; a cradle hands on",
              true},
      reflected_group);
}

}  // namespace core
}  // namespace kairos
