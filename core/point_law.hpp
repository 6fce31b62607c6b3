#pragma once

#include "core/impact_law.hpp"

namespace kairos {
inline namespace core {

/// One of two bodies of which a law has to know no more: neither turns, nothing drives it, and they
/// have no friction.
struct StruckPoint {
  double mass = 0.0;  ///< kg
  Vector3& velocity;  ///< m/s
};

/// An impact law that says so by being one: what it does to two such bodies takes no more than
/// this.
class PointLaw {
 public:
  virtual ~PointLaw() = default;

  /// `ImpactLaw::apply`, which changes nothing but their velocities, with the same bits.
  [[nodiscard]] virtual ImpactEnergy apply_to_points(const Contact& contact, const StruckPoint& a,
                                                     const StruckPoint& b) const = 0;
};

}  // namespace core
}  // namespace kairos
