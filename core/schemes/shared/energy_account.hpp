#pragma once

#include "core/energy_ledger.hpp"
#include "core/model.hpp"
#include "core/motion.hpp"
#include "core/plain_balls.hpp"
#include "core/stepper.hpp"

#include <span>
#include <vector>

namespace kairos {
inline namespace core {

/// One island over one stretch of time, as the ledger books it.
struct Leg {
  const Island& island;
  std::span<const BodyState> from;  ///< by place in the island, as what follows
  std::span<const BodyState> to;
  std::span<const Vector3> other_force;  ///< N: what acts beside gravity, constant
  bool exact = false;                    ///< the stepper has no truncation error
  double roundoff = 0.0;                 ///< of the step, where a replay told it, J
  double riding_work = 0.0;              ///< of a driven surface on a ball that it carries, J
  double contact_work = 0.0;  ///< of contact impulses within it, booked by who knows the lines, J
};

/// What roundoff did to the energy of a body between a step in exact arithmetic and the same step
/// as computed, under the constant force (N): m (v.dv - dv^2/2) - F.dp, J.
[[nodiscard]] double roundoff_energy(double mass, const Vector3& force, const BodyState& computed,
                                     const ReplayedStep& exact);

/// What a field does to a body that overlaps it, N. A field tells its force in the unit of G: per
/// kg of what it acts on, where gravity is an acceleration.
[[nodiscard]] Vector3 field_force(const Model& model, BodyIndex field, const BodyState& field_state,
                                  BodyIndex body);

/// What is told of all bodies, of those of an island: by place there.
template <typename T>
void gather(const Island& island, std::span<const T> of_all, std::vector<T>& out) {
  out.clear();
  for (const BodyIndex i : island.bodies) {
    out.push_back(of_all[i]);
  }
}

/// Books what forces did to the bodies between two states, line by line (see `EnergyLine`).
class EnergyAccount {
 public:
  EnergyAccount(const Model& model, EnergyLedger& ledger);

  /// Sets the energy that everything is compared with.
  void open(Instant t, std::span<const BodyState> bodies);
  /// Tells the ledger the energy at t.
  void balance(Instant t, std::span<const BodyState> bodies);

  /// Constant forces only: their work is force times displacement, exactly.
  /// truncation = change of kinetic energy - work of all forces along the motion.
  void leg(const Leg& leg);
  /// The same of a body that does not turn and falls exactly, with nothing but the uniform force of
  /// the model on it.
  void fallen(BodyIndex i, const BodyState& from, const BodyState& to);
  void fallen(const PlainBall& ball, const BodyState& from, const BodyState& to);
  /// The same with state-dependent forces, whose work is minus the change of their potential, or
  /// where they have none the integral of F dp along the motions (Gauss-Legendre, 8 points).
  /// `motions`: one per body of the island, covering [start, start + duration].
  void leg(const Leg& leg, std::span<const Motion> motions, Instant start, double duration);

  /// Work of a surface that carries a ball against the `forces` on it, along its unit `normal`, J:
  /// minus the work of their normal component along the motion of the ball.
  [[nodiscard]] double bearing_work(std::span<const Force* const> forces, const Motion& motion,
                                    const Vector3& normal, Instant start, double duration);

  /// Work of driven sides of joints along the motions of an island, J.
  [[nodiscard]] double joint_work(const Island& island, std::span<const Motion> motions,
                                  Instant start, double duration);
  /// States were put back onto the constraints of joints: books what that did, and returns its sum
  /// but for the driven share, J.
  double projected(const JointProjection& projection) {
    ledger_.add(EnergyLine::projection, projection.velocity);
    ledger_.add(EnergyLine::position_correction, projection.position);
    return projection.velocity + projection.position;
  }

  /// A hand took the bodies of an island from one state to another (both by place in the island):
  /// what that did to their energy at time t.
  void carried(const Island& island, Instant t, std::span<const BodyState> from,
               std::span<const BodyState> to);

  /// An impact changed the velocities of i: energy that it stored and gave back, turned into spin
  /// or out of it, or handed on is neither gain nor loss, but counts as flow.
  void struck(BodyIndex i, const BodyState& before, const BodyState& after);

  void struck(const PlainBall& ball, const BodyState& before, const BodyState& after);

  /// Kinetic energy that body i gained from one velocity to another at the same place, J.
  [[nodiscard]] double gained(BodyIndex i, const BodyState& from, const BodyState& to) const;

  /// A body was moved without time passing: work against gravity.
  void moved(BodyIndex i, const Vector3& displacement) {
    ledger_.add(EnergyLine::position_correction, -model_.gravity_force(i).dot(displacement));
  }
  /// The same of all bodies of an island, against its forces, too.
  void moved(const Island& island, Instant t, std::span<const BodyState> from,
             std::span<const BodyState> to);

 private:
  /// Counts what gravity and the new velocities changed into each other; returns the work, J.
  double exchanged(const Vector3& weight, const BodyInertia& inertia, const BodyState& from,
                   const BodyState& to);
  double exchanged(const Vector3& weight, const BodyState& from, const BodyState& to,
                   double renewed);
  /// Kinetic energy gained minus work of gravity and `other_force`, J; books the latter.
  double surplus(const Leg& leg);
  /// What the forces do to the bodies on their motions at t, into `wrenches_` and `along_`.
  void act(std::span<const Force* const> forces, std::span<const Motion> motions, Instant t);
  [[nodiscard]] double work_along(const Force& force, std::span<const Motion> motions,
                                  Instant start, double duration);
  [[nodiscard]] double kinetic(std::span<const BodyState> bodies) const;
  [[nodiscard]] double potential(Instant t, std::span<const BodyState> bodies);

  const Model& model_;
  EnergyLedger& ledger_;
  // Scratch, so that booking does not allocate.
  std::vector<BodyState> gathered_, along_;
  std::vector<Wrench> wrenches_;
};

}  // namespace core
}  // namespace kairos
