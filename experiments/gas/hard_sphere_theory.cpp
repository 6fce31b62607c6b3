#include "experiments/gas/hard_sphere_theory.hpp"

#include <cmath>
#include <iterator>
#include <numbers>

namespace kairos::experiments {

using std::numbers::pi;

double HardSpheres::density() const { return 6.0 * fraction / (pi * std::pow(diameter, 3)); }

double HardSpheres::carnahan_starling() const {
  const double f = fraction;
  return (1.0 + f + f * f - f * f * f) / std::pow(1.0 - f, 3);
}

double HardSpheres::kolafa() const {
  constexpr double coefficients[] = {1.0,        4.0,       6.0,        2.3647684,
                                     -0.8698551, 1.1062803, -1.095049,  0.637614,
                                     -0.2279397, 0.1098948, -0.00906797};
  const double x = fraction / (1.0 - fraction);
  double z = 0.0;
  for (auto c = std::rbegin(coefficients); c != std::rend(coefficients); ++c) {
    z = z * x + *c;
  }
  return z;
}

double HardSpheres::mean_free_time() const {
  return 1.0 /
         (4.0 * density() * diameter * diameter * contact_value() * std::sqrt(pi * kT / mass));
}

double HardSpheres::enskog_diffusion() const {
  constexpr double higher_orders = 1.01896;
  return higher_orders * 0.375 * std::sqrt(kT / (pi * mass)) /
         (density() * diameter * diameter * contact_value());
}

double HardSpheres::speedy_diffusion() const {
  const double n = density() * std::pow(diameter, 3);
  const double dilute = 0.375 * diameter * std::sqrt(kT / (pi * mass));
  return dilute / n * (1.0 - n / 1.09) * (1.0 + n * n * (0.4 - 0.83 * n * n));
}

double HardSpheres::enskog_viscosity() const {
  const double dilute = 1.016034 * 0.3125 * std::sqrt(mass * kT / pi) / (diameter * diameter);
  const double g = contact_value();
  const double y = 4.0 * fraction * g;
  return dilute * (1.0 + 0.8 * y + 0.7615 * y * y) / g;
}

double HardSpheres::diffusion_lost_in_box(double side) const {
  return 2.837297 * kT / (6.0 * pi * enskog_viscosity() * side);
}

}  // namespace kairos::experiments
