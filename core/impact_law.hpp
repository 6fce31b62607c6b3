#pragma once

#include "core/scene.hpp"

#include <string_view>

namespace kairos {
inline namespace core {

/// Where and how two bodies touch; bodies a and b as in the query that found it.
struct Contact {
  Vector3 point = Vector3::Zero();   ///< centroid of the contact patch, world frame, m
  Vector3 normal = Vector3::Zero();  ///< unit, from a to b, world frame
  double gap = 0.0;                  ///< m; negative: penetration
  double restitution = 1.0;          ///< of the pair, as the scene combines it
  double friction = 0.0;             ///< Coulomb's, of the pair; may be infinite
};

/// One of the two bodies, as a law may see and change it.
struct ImpactBody {
  const Body& body;
  const BodyInertia& inertia;  ///< mass -1: not free
  BodyState& state;
  Vector3& net_force;  ///< N: what the thesis' GivePhysForce adds to
};

/// What an impact did to the energy, by formula and not by difference; J, into the bodies.
struct ImpactEnergy {
  double restitution_loss = 0.0;   ///< <= 0
  double driven_work = 0.0;        ///< done by driven bodies
  double conveyor_and_hand = 0.0;  ///< done by belts (and hands)
  double impact_friction = 0.0;    ///< <= 0: what tangential impulses took
};

/// What an impact law is, and what it can do.
struct LawInfo {
  std::string_view name;
  bool needs_contact = false;  ///< uses the contact's point and normal
  std::string_view summary;
  /// Of a single contact without friction it is Newton's hypothesis, which joints can pass on.
  bool passed_on_by_joints = false;
  bool friction = false;  ///< treats it
  bool kinematic = true;  ///< v_n+ = -e v_n-: e is Newton's
};

/// Port: what do two bodies in contact do to each other?
class ImpactLaw {
 public:
  virtual ~ImpactLaw() = default;
  /// The same for the whole life of the law.
  [[nodiscard]] virtual LawInfo info() const = 0;
  /// Changes the velocities (and, for the thesis' nudge, positions) and net forces of both.
  virtual ImpactEnergy apply(const Contact& contact, ImpactBody a, ImpactBody b) const = 0;
  /// What rounding did to the energy in `apply`, which took the bodies from the states `before` to
  /// those that they have: kinetic energy as computed minus that of the same law in extended
  /// precision, J. 0 where that is not available.
  [[nodiscard]] virtual double roundoff(const Contact& /*contact*/, const ImpactBody& /*a*/,
                                        const ImpactBody& /*b*/, const BodyState& /*before_a*/,
                                        const BodyState& /*before_b*/) const {
    return 0.0;
  }
};

/// Relative normal velocity of b against a at the contact point, m/s; negative: approaching.
[[nodiscard]] double normal_velocity(const Contact& contact, const BodyState& a,
                                     const BodyState& b);

}  // namespace core
}  // namespace kairos
