#pragma once

#include "core/impact_law.hpp"

namespace kairos {
inline namespace core {

/// Axes of a contact, by column: n, then where `slip` points along the surface, then across both.
[[nodiscard]] Matrix3 contact_axes(const Vector3& n, const Vector3& slip);

/// A body as the contact feels it: velocities along the axes of the contact, and what impulses
/// along them do.
struct ContactSide {
  /// `sign`: 1 of the first body, -1 of the second.
  ContactSide(const ImpactBody& body, const Contact& contact, const Matrix3& axes, double sign);

  /// What an impulse does to the velocity of the point that touches, 1/kg.
  [[nodiscard]] Matrix3 compliance() const;
  void push(Twist& twist, const Vector3& impulse, const Matrix3& axes) const;

  bool free;
  bool turns;
  double mass;
  Vector3 principal;
  Quaternion principal_axes;  ///< in the world
  Matrix3 levers;             ///< r x axis, along the principal axes, by column
  Vector3 velocity;           ///< of the point that touches
  Vector3 belt;               ///< of its surface beside that
};

/// The two bodies of a contact, along axes of which the second is where their surfaces slide.
struct ContactSides {
  ContactSides(const Contact& contact, const ImpactBody& a, const ImpactBody& b);

  /// Velocity of the surface of b beside that of a, belts included, m/s.
  [[nodiscard]] Vector3 slip() const { return (b.velocity + b.belt) - (a.velocity + a.belt); }
  [[nodiscard]] Matrix3 compliance() const { return a.compliance() + b.compliance(); }
  /// The bodies take `impulse` on b, its opposite on a; what that does is added to what belts and
  /// driven bodies did.
  void push(const Vector3& impulse, ImpactBody& of_a, ImpactBody& of_b, ImpactEnergy& energy) const;

  Matrix3 axes;
  ContactSide a;
  ContactSide b;
};

}  // namespace core
}  // namespace kairos
