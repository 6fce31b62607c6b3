#include "integrators/elliptic.hpp"

#include "core/circular.hpp"
#include "core/exponential.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kairos::integrators {
namespace {

// Truncation errors of the series below: relative, far under roundoff [Carlson1995, eq. 2.4].
constexpr double series_error = 1e-18;
// How close the arguments have to be to their mean for that: 1 over this, of the mean.
const double reach_of_rc = power(3.0 * series_error, -1.0 / 8.0);
const double reach_of_rf = power(3.0 * series_error, -1.0 / 6.0);
const double reach_of_rj = power(0.25 * series_error, -1.0 / 6.0);

/// R_C(x, y) = R_F(x, y, y), x >= 0, y > 0 [Carlson1995, eqs. 2.12 to 2.18].
double carlson_rc(double x, double y) {
  double mean = (x + 2.0 * y) / 3.0;
  const double first_offset = y - mean;
  double bound = reach_of_rc * std::abs(mean - x);
  double quarter_power = 1.0;
  while (bound >= std::abs(mean)) {
    const double lambda = 2.0 * std::sqrt(x) * std::sqrt(y) + y;
    mean = 0.25 * (mean + lambda);
    x = 0.25 * (x + lambda);
    y = 0.25 * (y + lambda);
    bound *= 0.25;
    quarter_power *= 0.25;
  }
  const double s = quarter_power * first_offset / mean;
  const double series =
      1.0 +
      s * s *
          (3.0 / 10.0 +
           s * (1.0 / 7.0 + s * (3.0 / 8.0 + s * (9.0 / 22.0 + s * (159.0 / 208.0 + s * 1.125)))));
  return series / std::sqrt(mean);
}

}  // namespace

// [Carlson1995, eqs. 2.2 to 2.11].
double carlson_rf(double x, double y, double z) {
  const double first_mean = (x + y + z) / 3.0;
  const double x_offset = first_mean - x, y_offset = first_mean - y;
  double mean = first_mean;
  double bound =
      reach_of_rf * std::max({std::abs(x_offset), std::abs(y_offset), std::abs(first_mean - z)});
  double quarter_power = 1.0;
  while (bound >= mean) {
    const double rx = std::sqrt(x), ry = std::sqrt(y), rz = std::sqrt(z);
    const double lambda = rx * ry + rx * rz + ry * rz;
    mean = 0.25 * (mean + lambda);
    x = 0.25 * (x + lambda);
    y = 0.25 * (y + lambda);
    z = 0.25 * (z + lambda);
    bound *= 0.25;
    quarter_power *= 0.25;
  }
  const double X = quarter_power * x_offset / mean, Y = quarter_power * y_offset / mean;
  const double Z = -(X + Y);
  const double E2 = X * Y - Z * Z, E3 = X * Y * Z;
  return (1.0 - E2 / 10.0 + E3 / 14.0 + E2 * E2 / 24.0 - 3.0 * E2 * E3 / 44.0) / std::sqrt(mean);
}

// [Carlson1995, eqs. 2.19 to 2.29].
double carlson_rj(double x, double y, double z, double p) {
  const double first_mean = (x + y + z + 2.0 * p) / 5.0;
  const double x_offset = first_mean - x, y_offset = first_mean - y, z_offset = first_mean - z;
  double delta = (p - x) * (p - y) * (p - z);
  double mean = first_mean;
  double bound = reach_of_rj * std::max({std::abs(x_offset), std::abs(y_offset), std::abs(z_offset),
                                         std::abs(first_mean - p)});
  double quarter_power = 1.0, sum = 0.0;
  while (bound >= mean) {
    const double rx = std::sqrt(x), ry = std::sqrt(y), rz = std::sqrt(z), rp = std::sqrt(p);
    const double lambda = rx * ry + rx * rz + ry * rz;
    const double d = (rp + rx) * (rp + ry) * (rp + rz);
    sum += quarter_power / d * carlson_rc(1.0, 1.0 + delta / (d * d));
    mean = 0.25 * (mean + lambda);
    x = 0.25 * (x + lambda);
    y = 0.25 * (y + lambda);
    z = 0.25 * (z + lambda);
    p = 0.25 * (p + lambda);
    delta /= 64.0;
    bound *= 0.25;
    quarter_power *= 0.25;
  }
  const double X = quarter_power * x_offset / mean, Y = quarter_power * y_offset / mean;
  const double Z = quarter_power * z_offset / mean;
  const double P = -0.5 * (X + Y + Z);
  const double E2 = X * Y + X * Z + Y * Z - 3.0 * P * P;
  const double E3 = X * Y * Z + 2.0 * E2 * P + 4.0 * P * P * P;
  const double E4 = (2.0 * X * Y * Z + E2 * P + 3.0 * P * P * P) * P;
  const double E5 = X * Y * Z * P * P;
  const double series = 1.0 - 3.0 * E2 / 14.0 + E3 / 6.0 + 9.0 * E2 * E2 / 88.0 - 3.0 * E4 / 22.0 -
                        9.0 * E2 * E3 / 52.0 + 3.0 * E5 / 26.0;
  return quarter_power * series / (mean * std::sqrt(mean)) + 6.0 * sum;
}

// [DLMF, eq. 19.25.5].
double elliptic_f(double phi, double m) {
  const auto [s, c] = sine_cosine(phi);
  return s * carlson_rf(c * c, 1.0 - m * s * s, 1.0);
}

// [DLMF, eq. 19.25.14].
double elliptic_pi(double phi, double n, double m) {
  const auto [s, c] = sine_cosine(phi);
  const double q = 1.0 - m * s * s;
  return s *
         (carlson_rf(c * c, q, 1.0) - n / 3.0 * s * s * carlson_rj(c * c, q, 1.0, 1.0 + n * s * s));
}

double complete_elliptic_k(double m) { return carlson_rf(0.0, 1.0 - m, 1.0); }

double complete_elliptic_pi(double n, double m) {
  return carlson_rf(0.0, 1.0 - m, 1.0) - n / 3.0 * carlson_rj(0.0, 1.0 - m, 1.0, 1.0 + n);
}

JacobiFunctions jacobi_functions(double u, double m) {
  if (m >= 1.0) {
    const double sech = hyperbolic_secant(u);
    return {hyperbolic_tangent(u), sech, sech};
  }
  // The arithmetic-geometric mean converges quadratically: 6 steps do for 1 - m above 1e-16.
  constexpr std::size_t most = 16;
  std::array<double, most> ratio{};  // c_n / a_n
  double a = 1.0, b = std::sqrt(1.0 - m);
  std::size_t steps = 0;
  double power = 1.0;
  while (steps < most) {
    const double mean = 0.5 * (a + b), half_difference = 0.5 * (a - b);
    if (half_difference <= 1e-17 * mean) {
      break;
    }
    b = std::sqrt(a * b);
    a = mean;
    ratio[steps++] = half_difference / mean;
    power *= 2.0;
  }
  double phi = power * a * u;
  while (steps > 0) {
    phi = 0.5 * (phi + arc_sine(ratio[--steps] * sine(phi)));
  }
  const auto [sn, cn] = sine_cosine(phi);
  return {sn, cn, std::sqrt((1.0 - m) + m * cn * cn)};
}

}  // namespace kairos::integrators
