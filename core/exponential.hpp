#pragma once

namespace kairos {
inline namespace core {

// Exponential functions by additions, multiplications and divisions alone: the same bits
// everywhere, as those of core/circular.hpp. Within 0.52 units in the last place of the truth,
// where the result is neither subnormal nor infinite.

/// e to the power x; infinity where that is beyond the doubles.
[[nodiscard]] double exponential(double x);
/// Natural; minus infinity at 0, not a number below.
[[nodiscard]] double logarithm(double x);
/// x to the power y; not a number where x < 0 and y is no integer.
[[nodiscard]] double power(double x, double y);
/// x >= 0.
[[nodiscard]] double cube_root(double x);
/// Within 2 units in the last place.
[[nodiscard]] double hyperbolic_tangent(double x);
/// 1 / cosh x; within 2 units in the last place.
[[nodiscard]] double hyperbolic_secant(double x);

}  // namespace core
}  // namespace kairos
