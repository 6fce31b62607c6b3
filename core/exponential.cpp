#include "core/exponential.hpp"

#include "core/double_double.hpp"

#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr DoubleDouble log_2{0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
constexpr DoubleDouble third{0x1.5555555555555p-2, 0x1.5555555555555p-56};

/// c_0 + c_1 x + ... with c_k = 1 / (first + step k), degree of 12.
double odd_fractions(double x, double first) {
  double sum = 0.0;
  for (int k = 12; k >= 0; --k) {
    sum = sum * x + 1.0 / (first + 2.0 * k);
  }
  return sum;
}

/// log x, x > 0 and finite: 2 artanh((m - 1) / (m + 1)) + e log 2, where x = m 2^e.
DoubleDouble log_of(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < 0.70710678118654752) {
    m *= 2.0;
    --exponent;
  }
  const DoubleDouble s = DoubleDouble(m - 1.0) / two_sum(m, 1.0);
  const DoubleDouble z = s * s;  // at most 0.0295
  const DoubleDouble third_order = s * z * third;
  const double rest = s.high * z.high * z.high * odd_fractions(z.high, 5.0);
  const DoubleDouble half = s + (third_order + DoubleDouble(rest));
  return log_2 * DoubleDouble(exponent) + DoubleDouble(2.0 * half.high, 2.0 * half.low);
}

/// e^r - 1, |r| at most 0.35.
DoubleDouble small_growth(const DoubleDouble& r) {
  const double x = r.high;
  double rest = 0.0;
  for (int k = 16; k >= 3; --k) {
    rest = (1.0 + rest) * x / k;
  }
  const DoubleDouble square = r * r;
  const DoubleDouble half{0.5 * square.high, 0.5 * square.low};
  return r + (half + DoubleDouble(half.high * rest));
}

/// e^x = (1 + growth) 2^exponent.
struct Growth {
  DoubleDouble growth;
  int exponent = 0;
};

/// |x| < 1000.
Growth growth_of(const DoubleDouble& x) {
  const double n = std::floor(x.high / log_2.high + 0.5);
  return {small_growth(x - log_2 * DoubleDouble(n)), static_cast<int>(n)};
}

double exponential_of(const DoubleDouble& x) {
  if (x.high > 709.8 || x.high < -745.2) {
    return x.high > 0.0 ? infinity : 0.0;
  }
  const auto [growth, exponent] = growth_of(x);
  return std::ldexp((DoubleDouble(1.0) + growth).rounded(), exponent);
}

}  // namespace

double exponential(double x) { return std::isnan(x) ? x : exponential_of(x); }

double logarithm(double x) {
  if (!(x > 0.0)) {
    return x == 0.0 ? -infinity : not_a_number;
  }
  return x == infinity ? x : log_of(x).rounded();
}

double power(double x, double y) {
  if (y == 0.0 || x == 1.0) {
    return 1.0;
  }
  if (std::isnan(x) || std::isnan(y)) {
    return not_a_number;
  }
  const double size = std::abs(x);
  const bool odd = std::abs(std::fmod(y, 2.0)) == 1.0;
  if (x < 0.0 && std::isfinite(x) && std::isfinite(y) && std::floor(y) != y) {
    return not_a_number;
  }
  double result = 1.0;
  if (size == 0.0 || std::isinf(size)) {
    result = (size == 0.0) == (y < 0.0) ? infinity : 0.0;
  } else if (size != 1.0) {
    const DoubleDouble log = log_of(size);
    const double about = log.high * y;  // out of range before the product of two doubles is
    result = exponential_of(std::abs(about) < 800.0 ? log * DoubleDouble(y) : DoubleDouble(about));
  }
  return odd && std::signbit(x) ? -result : result;
}

double cube_root(double x) { return power(x, 1.0 / 3.0); }

double hyperbolic_tangent(double x) {
  const double size = std::abs(x);
  if (!(size < 20.0)) {
    return std::isnan(x) ? x : std::copysign(1.0, x);
  }
  const auto [growth, exponent] = growth_of(DoubleDouble(2.0 * size));
  // e^2x - 1 over e^2x + 1
  const double scale = std::ldexp(1.0, exponent);
  const DoubleDouble less =
      DoubleDouble(scale * growth.high, scale * growth.low) + DoubleDouble(scale - 1.0);
  return std::copysign((less / (less + DoubleDouble(2.0))).rounded(), x);
}

double hyperbolic_secant(double x) {
  const double size = std::abs(x);
  if (!(size < 350.0)) {
    return 2.0 * exponential(-size);
  }
  const auto [growth, exponent] = growth_of(DoubleDouble(size));
  const double scale = std::ldexp(1.0, exponent);
  const DoubleDouble e =
      DoubleDouble(scale) + DoubleDouble(scale * growth.high, scale * growth.low);
  return (DoubleDouble(2.0) / (e + DoubleDouble(1.0) / e)).rounded();
}

}  // namespace core
}  // namespace kairos
