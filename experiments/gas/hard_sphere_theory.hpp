#pragma once

namespace kairos::experiments {

/// What is known of a fluid of hard spheres of one kind, of diameter s and mass m, that fill a
/// fraction of space. kT in J.
struct HardSpheres {
  double fraction = 0.0;
  double diameter = 1.0;  ///< m
  double mass = 1.0;      ///< kg
  double kT = 1.0;        ///< J

  [[nodiscard]] double density() const;  ///< balls in a cubic metre

  /// Z = p V / (N kT) [CarnahanStarling1969]. Within some 0.3 % of computed ones up to freezing,
  /// at a fraction of 0.494.
  [[nodiscard]] double carnahan_starling() const;
  /// The same by a polynomial in f / (1 - f) that was fitted to computed pressures
  /// [Kolafa2004]: to some 1e-5 up to a fraction of 0.49.
  [[nodiscard]] double kolafa() const;
  /// Pair distribution at contact, of which Z = 1 + 4 f g.
  [[nodiscard]] double contact_value() const {
    return (carnahan_starling() - 1.0) / (4.0 * fraction);
  }
  /// Mean time of a ball between impacts, s: Enskog's, 1 / (4 n s^2 g sqrt(pi kT / m)) with
  /// `contact_value` [Chapman1970].
  [[nodiscard]] double mean_free_time() const;
  /// Self-diffusion, m^2/s: Enskog's, 3/8 sqrt(kT / (pi m)) / (n s^2 g), times 1.01896 (the
  /// higher orders of Sonine polynomials) [Chapman1970].
  [[nodiscard]] double enskog_diffusion() const;
  /// Self-diffusion fitted to computed ones, of infinitely many balls [Speedy1987].
  [[nodiscard]] double speedy_diffusion() const;
  /// Shear viscosity, kg/(m s): Enskog's [Chapman1970].
  [[nodiscard]] double enskog_viscosity() const;
  /// What is missing in a periodic box of that side (m), where each ball feels the flow that its
  /// images make: 2.837297 kT / (6 pi viscosity side) [Yeh2004].
  [[nodiscard]] double diffusion_lost_in_box(double side) const;
};

}  // namespace kairos::experiments
