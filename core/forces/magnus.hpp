#pragma once

#include "core/force.hpp"

namespace kairos {
inline namespace core {

/// Lift of a spinning ball, F = rho A r C_L (w x u) / 2, with u its velocity against the wind: a
/// lift coefficient C_L r |w| / |u|, linear in the spin parameter [Mehta1985]. It is perpendicular
/// to u, so in still air it does no work; yet it depends on velocity and has no potential.
class MagnusLift final : public Force {
 public:
  struct Parameters {
    double density = 1.2;            ///< rho of the gas, kg/m^3
    double lift_coefficient = 1.0;   ///< C_L, per unit of the spin parameter r |w| / |u|
    double radius = 0.0;             ///< r, m; A = pi r^2
    Vector3 wind = Vector3::Zero();  ///< velocity of the gas, m/s
  };
  /// Throws `InputError` for values that are negative or not finite.
  explicit MagnusLift(const Parameters& parameters);

  void add(Instant t, std::span<const BodyState> bodies, std::span<Wrench> wrenches) const override;
  [[nodiscard]] double potential(Instant t, std::span<const BodyState> bodies) const override;
  [[nodiscard]] bool conservative() const override { return false; }
  [[nodiscard]] std::string description() const override { return "Magnus lift"; }

 private:
  double coefficient_;  ///< rho pi r^3 C_L / 2, kg
  Vector3 wind_;
};

}  // namespace core
}  // namespace kairos
