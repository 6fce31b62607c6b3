#pragma once

#include "core/force.hpp"

namespace kairos {
inline namespace core {

/// Archimedes' buoyancy of a body wholly in a fluid, F = -rho V g: through the centre of volume,
/// which may be off the origin and then rights the body. Has a potential.
class Buoyancy final : public Force {
 public:
  struct Parameters {
    double density = 1.2;                 ///< rho of the fluid, kg/m^3
    double volume = 0.0;                  ///< V, m^3
    Vector3 gravity = {0.0, -9.81, 0.0};  ///< g, m/s^2
    Vector3 centre_B = Vector3::Zero();   ///< centre of volume, body frame, m
  };
  /// Throws `InputError` for values that are negative or not finite.
  explicit Buoyancy(const Parameters& parameters);

  void add(Instant t, std::span<const BodyState> bodies, std::span<Wrench> wrenches) const override;
  [[nodiscard]] double potential(Instant t, std::span<const BodyState> bodies) const override;
  [[nodiscard]] bool conservative() const override { return true; }
  [[nodiscard]] bool involves_rotation() const override { return !centre_B_.isZero(0.0); }
  [[nodiscard]] std::optional<Vector3> uniform() const override {
    return centre_B_.isZero(0.0) ? std::optional(force_) : std::nullopt;
  }
  [[nodiscard]] std::string description() const override { return "buoyancy"; }

 private:
  Vector3 force_;  ///< N
  Vector3 centre_B_;
};

}  // namespace core
}  // namespace kairos
