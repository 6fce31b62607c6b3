#include "core/schemes/shared/energy_account.hpp"

#include "core/joint_system.hpp"
#include "core/spin_energy.hpp"

#include <array>
#include <cassert>

namespace kairos {
inline namespace core {
namespace {

struct Node {
  double abscissa;  ///< in [0, 1]
  double weight;
};
/// Gauss-Legendre, 8 points: exact for polynomial power up to degree 15 [Abramowitz1964, 25.4.30].
constexpr std::array<Node, 8> nodes{{{0.019855071751231884, 0.050614268145188130},
                                     {0.101666761293186630, 0.111190517226687240},
                                     {0.237233795041835507, 0.156853322938943644},
                                     {0.408282678752175098, 0.181341891689180991},
                                     {0.591717321247824902, 0.181341891689180991},
                                     {0.762766204958164493, 0.156853322938943644},
                                     {0.898333238706813370, 0.111190517226687240},
                                     {0.980144928248768116, 0.050614268145188130}}};

/// 1/2 m (v1^2 - v0^2), factored so that nothing cancels.
double kinetic_gain(double m, const Vector3& v0, const Vector3& v1) {
  return 0.5 * m * (v1 - v0).dot(v1 + v0);
}

/// Energy that rotation gained, by principal axis: a body that tumbles moves it from one to
/// another.
Vector3 spin_gains(const BodyInertia& inertia, const BodyState& from, const BodyState& to) {
  const Vector3 w0 = principal_rates(inertia, from);
  const Vector3 w1 = principal_rates(inertia, to);
  return 0.5 * inertia.principal.cwiseProduct((w1 - w0).cwiseProduct(w1 + w0));
}

/// Energy in those velocity components of a body that changed, after the change, J.
double renewed(double mass, const BodyState& from, const BodyState& to) {
  double energy = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double v = to.twist.linear[axis];
    energy += v != from.twist.linear[axis] ? 0.5 * mass * v * v : 0.0;
  }
  return energy;
}

/// The same with its rotation.
double renewed(const BodyInertia& inertia, const BodyState& from, const BodyState& to) {
  double energy = renewed(inertia.mass, from, to);
  if (inertia.rotates && to.twist.angular != from.twist.angular) {
    energy += spin_energy(inertia, to);
  }
  return energy;
}

double potential_of(const Island& island, Instant t, std::span<const BodyState> states) {
  double energy = 0.0;
  for (const Force* force : island.forces) {
    energy += force->potential(t, states);
  }
  return energy;
}

}  // namespace

double roundoff_energy(double mass, const Vector3& force, const BodyState& computed,
                       const ReplayedStep& exact) {
  const Vector3 dv = (computed.twist.linear - exact.velocity_high) - exact.velocity_low;
  const Vector3 dp = (computed.pose.position - exact.position_high) - exact.position_low;
  return mass * (computed.twist.linear - 0.5 * dv).dot(dv) - force.dot(dp);
}

Vector3 field_force(const Model& model, BodyIndex field, const BodyState& field_state,
                    BodyIndex body) {
  const Vector3 offered = model.entity(field).get_force(model.body(field), field_state);
  const bool per_mass = model.scene().gravity == GravityMode::acceleration;
  Vector3 taken = Vector3::Zero();
  model.entity(body).give_force(taken,
                                per_mass ? Vector3(model.inertia(body).mass * offered) : offered);
  return taken;
}

EnergyAccount::EnergyAccount(const Model& model, EnergyLedger& ledger)
    : model_(model), ledger_(ledger) {}

double EnergyAccount::exchanged(const Vector3& weight, const BodyInertia& inertia,
                                const BodyState& from, const BodyState& to) {
  return exchanged(weight, from, to, renewed(inertia, from, to));
}

double EnergyAccount::exchanged(const Vector3& weight, const BodyState& from, const BodyState& to,
                                double renewed) {
  const Vector3 displacement = to.pose.position - from.pose.position;
  const double falls = weight.dot(displacement);
  ledger_.exchange(falls);
  ledger_.exchange(renewed);
  for (int axis = 0; axis < 3; ++axis) {
    if (displacement[axis] != 0.0) {
      ledger_.exchange(weight[axis] * to.pose.position[axis]);
    }
  }
  return falls;
}

void EnergyAccount::fallen(BodyIndex i, const BodyState& from, const BodyState& to) {
  (void)exchanged(model_.gravity_force(i), model_.inertia(i), from, to);
}

void EnergyAccount::fallen(const PlainBall& ball, const BodyState& from, const BodyState& to) {
  (void)exchanged(ball.weight, from, to, renewed(ball.mass, from, to));
}

double EnergyAccount::surplus(const Leg& leg) {
  assert(leg.from.size() == leg.to.size() && leg.other_force.size() == leg.to.size());
  double surplus = 0.0;
  for (std::size_t k = 0; k < leg.island.bodies.size(); ++k) {
    const BodyIndex i = leg.island.bodies[k];
    const BodyInertia& inertia = leg.island.inertia[k];
    const BodyState& from = leg.from[k];
    const BodyState& to = leg.to[k];
    const double falls = exchanged(model_.gravity_force(i), inertia, from, to);
    const double other = leg.other_force[k].dot(to.pose.position - from.pose.position);
    if (other != 0.0) {
      ledger_.add(EnergyLine::field_work, other);
    }
    double gain = kinetic_gain(inertia.mass, from.twist.linear, to.twist.linear);
    if (inertia.rotates) {
      const Vector3 gains = spin_gains(inertia, from, to);
      ledger_.exchange(gains.cwiseAbs().sum());
      gain += gains.sum();
    }
    surplus += gain - falls - other;
  }
  if (leg.roundoff != 0.0) {
    ledger_.add(EnergyLine::roundoff, leg.roundoff);
    surplus -= leg.roundoff;
  }
  if (leg.riding_work != 0.0) {
    ledger_.add(EnergyLine::driven_work, leg.riding_work);
    surplus -= leg.riding_work;
  }
  return surplus - leg.contact_work;
}

void EnergyAccount::act(std::span<const Force* const> forces, std::span<const Motion> motions,
                        Instant t) {
  along_.clear();
  for (const Motion& motion : motions) {
    const double s = t - motion.start;
    along_.push_back({motion.pose(s), motion.twist(s)});
  }
  wrenches_.assign(motions.size(), Wrench{});
  for (const Force* force : forces) {
    force->add(t, along_, wrenches_);
  }
}

/// Integral of power over the motions, for a force without a potential.
double EnergyAccount::work_along(const Force& force, std::span<const Motion> motions, Instant start,
                                 double duration) {
  const Force* const forces[] = {&force};
  double work = 0.0;
  for (const Node& node : nodes) {
    const Instant t = start + node.abscissa * duration;
    act(forces, motions, t);
    for (std::size_t k = 0; k < motions.size(); ++k) {
      // The derivative of the path, which in a dense output may differ from `twist`.
      const Vector3 path_velocity = motions[k].position.derivative(t - motions[k].start);
      work += node.weight * duration *
              (wrenches_[k].force.dot(path_velocity) +
               wrenches_[k].torque.dot(along_[k].twist.angular));
    }
  }
  return work;
}

double EnergyAccount::bearing_work(std::span<const Force* const> forces, const Motion& motion,
                                   const Vector3& normal, Instant start, double duration) {
  double work = 0.0;
  for (const Node& node : nodes) {
    const Instant t = start + node.abscissa * duration;
    act(forces, {&motion, 1}, t);
    work -= node.weight * duration * normal.dot(wrenches_[0].force) *
            normal.dot(motion.position.derivative(t - motion.start));
  }
  return work;
}

double EnergyAccount::joint_work(const Island& island, std::span<const Motion> motions,
                                 Instant start, double duration) {
  double work = 0.0;
  if (!island.joints->driven()) {
    return work;
  }
  for (const Node& node : nodes) {
    const Instant t = start + node.abscissa * duration;
    act(std::span(island.forces).first(island.forces.size() - 1), motions, t);
    for (std::size_t k = 0; k < motions.size(); ++k) {
      wrenches_[k].force += island.constant_force[k];
    }
    work += node.weight * duration * island.joints->driven_power(t, along_, wrenches_);
  }
  return work;
}

void EnergyAccount::leg(const Leg& leg) {
  const double truncation = surplus(leg);
  if (!leg.exact) {
    ledger_.add(EnergyLine::truncation, truncation);
  }
}

void EnergyAccount::leg(const Leg& leg, std::span<const Motion> motions, Instant start,
                        double duration) {
  assert(motions.size() == leg.island.bodies.size() && duration >= 0.0);
  double truncation = surplus(leg);
  for (const Force* force : leg.island.forces) {
    if (force->conservative()) {
      const double work =
          force->potential(start, leg.from) - force->potential(start + duration, leg.to);
      ledger_.exchange(work);
      truncation -= work;
    } else {
      const double stored =
          force->potential(start + duration, leg.to) - force->potential(start, leg.from);
      const double work = work_along(*force, motions, start, duration);
      ledger_.add(EnergyLine::field_work, work + stored);
      truncation -= work;
    }
  }
  if (!leg.exact) {
    ledger_.add(EnergyLine::truncation, truncation);
  }
}

void EnergyAccount::carried(const Island& island, Instant t, std::span<const BodyState> from,
                            std::span<const BodyState> to) {
  double work = 0.0;
  for (std::size_t k = 0; k < island.bodies.size(); ++k) {
    const BodyInertia& inertia = island.inertia[k];
    work += kinetic_gain(inertia.mass, from[k].twist.linear, to[k].twist.linear) -
            model_.gravity_force(island.bodies[k]).dot(to[k].pose.position - from[k].pose.position);
    if (inertia.rotates) {
      work += spin_energy(inertia, to[k]) - spin_energy(inertia, from[k]);
    }
  }
  if (!island.forces.empty()) {
    work += potential_of(island, t, to) - potential_of(island, t, from);
  }
  ledger_.add(EnergyLine::conveyor_and_hand, work);
}

void EnergyAccount::struck(BodyIndex i, const BodyState& before, const BodyState& after) {
  const BodyInertia& inertia = model_.inertia(i);
  ledger_.exchange(renewed(inertia, after, before));
  ledger_.exchange(renewed(inertia, before, after));
}

void EnergyAccount::struck(const PlainBall& ball, const BodyState& before, const BodyState& after) {
  ledger_.exchange(renewed(ball.mass, after, before));
  ledger_.exchange(renewed(ball.mass, before, after));
}

void EnergyAccount::moved(const Island& island, Instant t, std::span<const BodyState> from,
                          std::span<const BodyState> to) {
  for (std::size_t k = 0; k < island.bodies.size(); ++k) {
    moved(island.bodies[k], to[k].pose.position - from[k].pose.position);
  }
  if (!island.forces.empty()) {
    ledger_.add(EnergyLine::position_correction,
                potential_of(island, t, to) - potential_of(island, t, from));
  }
}

double EnergyAccount::gained(BodyIndex i, const BodyState& from, const BodyState& to) const {
  const BodyInertia& inertia = model_.inertia(i);
  const double linear = kinetic_gain(inertia.mass, from.twist.linear, to.twist.linear);
  return linear + (inertia.rotates ? spin_gains(inertia, from, to).sum() : 0.0);
}

void EnergyAccount::open(Instant t, std::span<const BodyState> bodies) {
  ledger_.open(kinetic(bodies), potential(t, bodies));
  ledger_.exchange(ledger_.kinetic());
  for (const BodyIndex i : model_.free_by_name()) {  // one by one: their sum may cancel
    ledger_.exchange(model_.gravity_potential(i, bodies[i].pose.position));
  }
  for (const Island& island : model_.islands()) {
    gather(island, bodies, gathered_);
    ledger_.exchange(potential_of(island, t, gathered_));
  }
}

void EnergyAccount::balance(Instant t, std::span<const BodyState> bodies) {
  ledger_.balance(kinetic(bodies), potential(t, bodies));
}

double EnergyAccount::kinetic(std::span<const BodyState> bodies) const {
  CompensatedSum sum;
  for (const BodyIndex i : model_.free_by_name()) {
    sum.add(model_.kinetic_energy(i, bodies[i]));
  }
  return sum.value();
}

double EnergyAccount::potential(Instant t, std::span<const BodyState> bodies) {
  CompensatedSum sum;
  for (const BodyIndex i : model_.free_by_name()) {
    // The potentials of bodies above and below the origin cancel; their roundings would not.
    const Vector3& force = model_.gravity_force(i);
    for (int axis = 0; axis < 3; ++axis) {
      sum.add_product(-force[axis], bodies[i].pose.position[axis]);
    }
  }
  for (const Island& island : model_.islands()) {
    if (!island.forces.empty()) {
      gather(island, bodies, gathered_);
      sum.add(potential_of(island, t, gathered_));
    }
  }
  return sum.value();
}

}  // namespace core
}  // namespace kairos
