#pragma once

namespace kairos {
inline namespace core {

/// Sine and cosine of one angle.
struct SineCosine {
  double sine = 0.0;
  double cosine = 1.0;
};

// Circular functions by additions, multiplications, divisions and square roots alone, which IEEE
// 754 rounds in one way: the same bits on every machine, with every C library, and in a page. Those
// of C libraries differ in the last digit, from each other and with the processor.
//
// Sine, cosine and arc tangent are the number of doubles that is nearest, or within 0.51 units in
// the last place of the truth, over the whole range: arguments are reduced by pi to as many digits
// as they ask for [PayneHanek1983].

/// x in rad; not a number where x is not finite.
[[nodiscard]] SineCosine sine_cosine(double x);
/// x in rad; not a number where x is not finite.
[[nodiscard]] double sine(double x);
/// x in rad; not a number where x is not finite.
[[nodiscard]] double cosine(double x);

/// The length of (x, y), within 1 unit in the last place where no square over- or underflows.
[[nodiscard]] double hypotenuse(double x, double y);
/// The angle of (x, y) from +x, -pi to pi, rad; signs of zeros and infinities as IEEE 754's atan2.
[[nodiscard]] double arc_tangent(double y, double x);
/// Within 2 units in the last place, -1 <= x <= 1, rad.
[[nodiscard]] double arc_sine(double x);
/// Within 2 units in the last place, -1 <= x <= 1, rad.
[[nodiscard]] double arc_cosine(double x);

}  // namespace core
}  // namespace kairos
