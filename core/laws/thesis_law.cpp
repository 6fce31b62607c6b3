#include "core/laws/thesis_law.hpp"

namespace kairos {
inline namespace core {
namespace {

/// What one side has to offer, read before anything is changed.
struct Offer {
  Momentum momentum;
  Vector3 force;
};

Offer read(const ImpactBody& giver) {
  const Entity& entity = *giver.body.entity;
  return {entity.get_momentum(giver.body, giver.state), entity.get_force(giver.body, giver.state)};
}

std::optional<Vector3> normal_for(const ImpactBody& giver, const ImpactBody& taker,
                                  const Vector3& centre_line) {
  if (giver.body.entity->stationary()) {
    return giver.body.normal(giver.state.pose);
  }
  if (giver.body.collision_type == CollisionType::round &&
      taker.body.collision_type == CollisionType::round) {
    return centre_line;
  }
  return std::nullopt;
}

/// Energy that a giver which is not itself part of the balance (bat, belt) hands over when `taker`
/// exchanges momentum with it elastically: impulse times the velocity of the common centre of
/// mass, 2 m m2/(m+m2) (v2-v).(m v + m2 v2)/(m+m2). The reflection that may follow adds nothing.
double exchange_work(const Momentum& given, double m, const Vector3& v) {
  const double total = m + given.mass;
  const Vector3 impulse = (2.0 * m * given.mass / total) * (given.velocity - v);
  const Vector3 centre_velocity = (m * v + given.mass * given.velocity) / total;
  return impulse.dot(centre_velocity);
}

void book(const ImpactBody& giver, const Momentum& given, double m, const Vector3& v,
          ImpactEnergy& energy) {
  if (m <= 0.0 || given.mass == -1.0) {
    return;  // nothing that has energy took, or a reflection: no work
  }
  if (giver.inertia.mass > 0.0) {
    return;  // free: what one gains the other loses
  }
  const double work = exchange_work(given, m, v);
  (giver.body.drive != nullptr ? energy.driven_work : energy.conveyor_and_hand) += work;
}

class ThesisLaw final : public ImpactLaw {
 public:
  [[nodiscard]] LawInfo info() const override {
    return {"thesis", false, "Get/Give of momentum and force, no approach test (thesis, 13.5)"};
  }

  ImpactEnergy apply(const Contact&, ImpactBody a, ImpactBody b) const override {
    const Offer of_a = read(a);
    const Offer of_b = read(b);
    Vector3 centre_line = b.state.pose.position - a.state.pose.position;
    const double distance = centre_line.norm();
    centre_line = distance > 0.0 ? Vector3(centre_line / distance) : Vector3::Zero();

    a.body.entity->give_force(a.net_force, of_b.force);
    b.body.entity->give_force(b.net_force, of_a.force);

    ImpactEnergy energy;
    give(of_a, a, b, centre_line, energy);
    give(of_b, b, a, centre_line, energy);
    return energy;
  }

 private:
  static void give(const Offer& offer, const ImpactBody& giver, const ImpactBody& taker,
                   const Vector3& centre_line, ImpactEnergy& energy) {
    book(giver, offer.momentum, taker.inertia.mass, taker.state.twist.linear, energy);
    const Entity& from = *giver.body.entity;
    taker.body.entity->give_momentum(
        taker.body, taker.state,
        {from.physics_type(), offer.momentum, normal_for(giver, taker, centre_line), from.nudge()});
  }
};

}  // namespace

std::unique_ptr<ImpactLaw> make_thesis_law() { return std::make_unique<ThesisLaw>(); }

}  // namespace core
}  // namespace kairos
