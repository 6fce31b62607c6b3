#pragma once

#include <cmath>
#include <limits>

namespace kairos::ccd {

/// Unit roundoff u of a double: every operation is exact up to a factor 1 + d with |d| <= u.
inline constexpr double unit_roundoff = 0.5 * std::numeric_limits<double>::epsilon();
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Distance from x to the next larger double in magnitude (an ulp of x, at most 2u|x|).
[[nodiscard]] inline double ulp(double x) {
  return 2.0 * unit_roundoff * std::abs(x) + std::numeric_limits<double>::denorm_min();
}

/// A sum or product and what its rounding lost [Knuth1997, 4.2.2], [Dekker1971].
struct Exact {
  double value;
  double lost;
};
[[nodiscard]] inline Exact two_sum(double a, double b) {
  const double sum = a + b;
  const double virtual_b = sum - a;
  return {sum, (a - (sum - virtual_b)) + (b - virtual_b)};
}
[[nodiscard]] inline Exact two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

/// Sum and product of numbers in twice the precision, off by at most 8 u^2 of themselves (of the
/// terms, where a sum cancels) [Dekker1971].
[[nodiscard]] inline Exact sum(Exact a, Exact b) {
  const Exact high = two_sum(a.value, b.value);
  return two_sum(high.value, high.lost + (a.lost + b.lost));
}
[[nodiscard]] inline Exact product(Exact a, Exact b) {
  const Exact high = two_product(a.value, b.value);
  return two_sum(high.value, high.lost + (a.value * b.lost + a.lost * b.value));
}

/// a b - c d with an error of at most 2 ulp, by Kahan's method [Jeannerod2013].
[[nodiscard]] inline double difference_of_products(double a, double b, double c, double d) {
  const double cd = c * d;
  const double error = std::fma(-c, d, cd);
  return std::fma(a, b, -cd) + error;
}

}  // namespace kairos::ccd
