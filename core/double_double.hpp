#pragma once

#include <cmath>

namespace kairos {
inline namespace core {

/// A number as the unevaluated sum of two doubles: about 106 bits [Dekker1971], [Hida2001].
/// Valid while |values| stay below 2^996, where splitting would overflow.
struct DoubleDouble {
  double high = 0.0;
  double low = 0.0;

  constexpr DoubleDouble() = default;
  // A double is a DoubleDouble: kernels are written once for both.
  constexpr DoubleDouble(double value) : high(value) {}  // NOLINT(google-explicit-constructor)
  constexpr DoubleDouble(double high_part, double low_part) : high(high_part), low(low_part) {}

  [[nodiscard]] constexpr double rounded() const { return high + low; }
};

/// a + b without error, if |a| >= |b| [Dekker1971].
constexpr DoubleDouble fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a + b without error [Knuth1997, 4.2.2].
constexpr DoubleDouble two_sum(double a, double b) {
  const double sum = a + b;
  const double virtual_b = sum - a;
  return {sum, (a - (sum - virtual_b)) + (b - virtual_b)};
}

/// a b without error [Dekker1971]: by the hardware's fused multiply-add where there is one, by
/// splitting into halves of 26 bits elsewhere (libm's emulation would be slower). Same bits.
inline DoubleDouble two_product(double a, double b) {
  const double product = a * b;
#ifdef FP_FAST_FMA
  return {product, std::fma(a, b, -product)};
#else
  constexpr double splitter = 134217729.0;  // 2^27 + 1
  const double scaled_a = splitter * a;
  const double a_high = scaled_a - (scaled_a - a);
  const double a_low = a - a_high;
  const double scaled_b = splitter * b;
  const double b_high = scaled_b - (scaled_b - b);
  const double b_low = b - b_high;
  return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
#endif
}

constexpr DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }

constexpr DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = two_sum(a.high, b.high);
  const DoubleDouble low = two_sum(a.low, b.low);
  const DoubleDouble sum = fast_two_sum(high.high, high.low + low.high);
  return fast_two_sum(sum.high, sum.low + low.low);
}
constexpr DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + (-b); }

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = two_product(a.high, b.high);
  return fast_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double first = a.high / b.high;
  const DoubleDouble rest = a - b * DoubleDouble(first);
  const double second = rest.high / b.high;
  const double third = (rest - b * DoubleDouble(second)).high / b.high;
  return fast_two_sum(first, second) + DoubleDouble(third);
}

}  // namespace core
}  // namespace kairos
