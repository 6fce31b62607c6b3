#pragma once

#include "core/contact_detector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

/// An independent answer to "how far apart are they at t": everything in long double, from the
/// definition of the motions, by the textbook test with normalised axes. Nothing of ccd is used.
namespace kairos::reference {

using Real = long double;
using Vec = Eigen::Matrix<Real, 3, 1>;
using Mat = Eigen::Matrix<Real, 3, 3>;

[[nodiscard]] Vec position(const Motion& motion, Real s);
/// p_b - p_a; at equal times the coefficients are subtracted first, which is exact for doubles of
/// like size, however far from the origin.
[[nodiscard]] Vec relative_position(const Motion& a, Real s_a, const Motion& b, Real s_b);
[[nodiscard]] Mat orientation(const Motion& motion, Real s);

/// Signed separation: positive exactly when apart (for boxes without error radii, the greatest over
/// the 15 axes, which is between 1/sqrt(3) of the distance and the distance).
[[nodiscard]] Real separation(const MovingShape& a, Real s_a, const MovingShape& b, Real s_b);

/// Counter-based random numbers: the n-th draw of a seed is a hash of both (SplitMix64).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ull) {}
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53;
  }
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  int below(int n) { return static_cast<int>(bits() % static_cast<std::uint64_t>(n)); }
  /// Each component within `size`.
  Vector3 vector(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }
  /// A unit vector.
  Vector3 direction();
  Quaternion orientation();

 private:
  std::uint64_t state_;
};

/// Least separation over [t0, t1]: dense samples, and golden-section around the lowest of them.
template <typename F>
Real least(const F& separation_at, Real t0, Real t1, int samples) {
  int lowest = 0;
  Real value = std::numeric_limits<Real>::infinity();
  const Real step = (t1 - t0) / samples;
  for (int i = 0; i <= samples; ++i) {
    const Real x = separation_at(t0 + step * i);
    if (x < value) {
      value = x;
      lowest = i;
    }
  }
  Real low = t0 + step * std::max(0, lowest - 1);
  Real high = t0 + step * std::min(samples, lowest + 1);
  constexpr Real golden = 0.6180339887498948482L;
  for (int i = 0; i < 60; ++i) {
    const Real m1 = high - golden * (high - low);
    const Real m2 = low + golden * (high - low);
    const Real f1 = separation_at(m1);
    const Real f2 = separation_at(m2);
    value = std::min({value, f1, f2});
    (f1 < f2 ? high : low) = f1 < f2 ? m2 : m1;
  }
  return value;
}

}  // namespace kairos::reference
