#pragma once

#include "core/force.hpp"

namespace kairos {
inline namespace core {

/// Drag of a body in a gas at high Reynolds number, F = -rho Cd A |u| u / 2, with u its velocity
/// against the wind [Batchelor1967, sec. 5.11]. On every body it is given, through its origin.
class QuadraticDrag final : public Force {
 public:
  struct Parameters {
    double density = 1.2;            ///< rho of the gas, kg/m^3
    double drag_coefficient = 0.45;  ///< Cd; a smooth sphere's below Re = 2e5
    double area = 0.0;               ///< A, seen from ahead, m^2
    Vector3 wind = Vector3::Zero();  ///< velocity of the gas, m/s
  };
  /// Throws `InputError` for values that are negative or not finite.
  explicit QuadraticDrag(const Parameters& parameters);

  void add(Instant t, std::span<const BodyState> bodies, std::span<Wrench> wrenches) const override;
  [[nodiscard]] double potential(Instant t, std::span<const BodyState> bodies) const override;
  [[nodiscard]] bool conservative() const override { return false; }
  [[nodiscard]] bool involves_rotation() const override { return false; }
  [[nodiscard]] std::string description() const override { return "quadratic drag"; }
  /// rho Cd A / 2, kg/m.
  [[nodiscard]] double coefficient() const { return coefficient_; }
  [[nodiscard]] const Vector3& wind() const { return wind_; }

 private:
  double coefficient_;  ///< rho Cd A / 2, kg/m
  Vector3 wind_;
};

/// Drag of a slow body, F = -b u and torque -b_r w; for a sphere of radius r in a fluid of
/// viscosity mu, b = 6 pi mu r and b_r = 8 pi mu r^3 [Batchelor1967, sec. 4.9].
class LinearDrag final : public Force {
 public:
  struct Parameters {
    double coefficient = 0.0;        ///< b, kg/s
    double rotational = 0.0;         ///< b_r, kg m^2/s
    Vector3 wind = Vector3::Zero();  ///< velocity of the fluid, m/s
  };
  /// Throws `InputError` for values that are negative or not finite.
  explicit LinearDrag(const Parameters& parameters);

  void add(Instant t, std::span<const BodyState> bodies, std::span<Wrench> wrenches) const override;
  [[nodiscard]] double potential(Instant t, std::span<const BodyState> bodies) const override;
  [[nodiscard]] bool conservative() const override { return false; }
  [[nodiscard]] bool involves_rotation() const override { return parameters_.rotational != 0.0; }
  [[nodiscard]] std::string description() const override { return "linear drag"; }

 private:
  Parameters parameters_;
};

}  // namespace core
}  // namespace kairos
