#pragma once

#include "core/instant.hpp"
#include "core/state.hpp"

#include <optional>
#include <span>
#include <string>

namespace kairos {
inline namespace core {

class Archive;
class JointSystem;

/// Force through the origin of a body and torque about it, world frame (N, N m).
struct Wrench {
  Vector3 force = Vector3::Zero();
  Vector3 torque = Vector3::Zero();

  /// Writes it to a checkpoint, or reads it back.
  void persist(Archive& archive);
};

/// Inertia of one body of an island.
struct BodyInertia {
  double mass = 0.0;                         ///< kg, > 0
  Vector3 principal = Vector3::Zero();       ///< principal moments, kg m^2
  bool rotates = false;                      ///< false: orientation is not integrated at all
  double bounding_radius = 0.0;              ///< of its shape about its origin, m
  Quaternion axes = Quaternion::Identity();  ///< the principal axes, in body axes

  /// The principal axes of a body of orientation `q_WB` in the world.
  [[nodiscard]] Quaternion principal_axes(const Quaternion& q_WB) const {
    return axes.vec().isZero(0.0) ? q_WB : Quaternion(q_WB * axes);
  }
  /// I^-1 x of a body that turns, world frame.
  [[nodiscard]] Vector3 inverse(const Quaternion& q_WB, const Vector3& x) const;
  /// I^-1 of a body that turns, world frame, 1/(kg m^2).
  [[nodiscard]] Matrix3 inverse(const Quaternion& q_WB) const;
};

/// Port: a force that depends on the state or on time (drag, spring, Magnus). Constant forces are
/// not `Force`s: an `Island` holds their sum per body, so that motions stay closed-form.
class Force {
 public:
  virtual ~Force() = default;
  /// Adds to the wrenches of the island's bodies at time t; arrays are indexed as the island's.
  virtual void add(Instant t, std::span<const BodyState> bodies,
                   std::span<Wrench> wrenches) const = 0;
  /// Potential energy, J; 0 for forces that have none.
  [[nodiscard]] virtual double potential(Instant t, std::span<const BodyState> bodies) const = 0;
  /// True if `potential` tells the whole work of the force.
  [[nodiscard]] virtual bool conservative() const = 0;
  /// Whether it turns its bodies or depends on how they turn, so that rotation is integrated. A
  /// force that does not say may.
  [[nodiscard]] virtual bool involves_rotation() const { return true; }
  /// N, on each of its bodies, of a force that is the same whatever state and time, through the
  /// origin and of potential -F.p: it leaves motions closed-form. nullopt otherwise.
  [[nodiscard]] virtual std::optional<Vector3> uniform() const { return std::nullopt; }
  /// For people: what it is, and on whom.
  [[nodiscard]] virtual std::string description() const = 0;
};

/// What putting states back onto the constraints of joints did to their energy, J, into the bodies.
struct JointProjection {
  double velocity = 0.0;  ///< impulses on velocities: sum p (u- + u+) / 2, u relative
  double driven = 0.0;    ///< share of driven sides in that
  double position = 0.0;  ///< minus the work of the constant forces on the displacement
  bool converged = true;
};

/// The bodies that forces and joints couple: what a `Stepper` advances. Usually one body.
struct Island {
  std::vector<BodyIndex> bodies;        ///< indices into the model
  std::vector<BodyInertia> inertia;     ///< one per body
  std::vector<Vector3> constant_force;  ///< one per body, N: gravity, given forces, active fields
  std::vector<const Force*> forces;     ///< state- or time-dependent, not owned
  /// What holds its bodies together, not owned; null: nothing. Its forces are then the last of
  /// `forces`.
  const JointSystem* joints = nullptr;

  /// Wrenches on all bodies at time t.
  void wrenches(Instant t, std::span<const BodyState> states, std::span<Wrench> out) const;
  /// True when the only forces are constant: translation is then a parabola.
  [[nodiscard]] bool constant_acceleration() const { return forces.empty(); }
};

/// Angular acceleration, world frame, rad/s^2: R I^-1 (R^T torque - w_B x I w_B).
[[nodiscard]] Vector3 angular_acceleration(const BodyInertia& inertia, const BodyState& state,
                                           const Vector3& torque);

}  // namespace core
}  // namespace kairos
