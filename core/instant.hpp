#pragma once

#include <cmath>
#include <compare>
#include <limits>

namespace kairos {
inline namespace core {

/// A moment on the absolute time axis, as the unevaluated sum of two doubles (s).
///
/// Time does not wear out: after 1e6 s a plain double resolves only 1e-10 s. An `Instant` keeps
/// about 106 bits, so an impact is as finely resolved after a week as in the first second
/// [Dekker1971], [Knuth1997, 4.2.2]. Invariant: `seconds` is the sum rounded to nearest.
struct Instant {
  double seconds = 0.0;     ///< the instant rounded to a double, s
  double correction = 0.0;  ///< what that rounding lost, s

  /// Later than all instants that come.
  static constexpr Instant never() { return {std::numeric_limits<double>::infinity(), 0.0}; }

  /// The instant `duration` seconds later; `duration` may be negative or infinite.
  friend constexpr Instant operator+(Instant t, double duration) {
    const double sum = t.seconds + duration;
    if (!(sum - sum == 0.0)) {
      return {sum, 0.0};  // infinity stays what it is
    }
    const double virtual_duration = sum - t.seconds;
    const double lost = (t.seconds - (sum - virtual_duration)) + (duration - virtual_duration);
    const double low = t.correction + lost;
    const double high = sum + low;
    return {high, low - (high - sum)};
  }
  /// The instant `duration` seconds earlier.
  friend constexpr Instant operator-(Instant t, double duration) { return t + (-duration); }
  /// Seconds from `earlier` to `later`, rounded once.
  friend constexpr double operator-(Instant later, Instant earlier) {
    return (later.seconds - earlier.seconds) + (later.correction - earlier.correction);
  }
  /// The order of time.
  // clang-tidy 14 takes it for a comparison with 0.
  friend constexpr auto operator<=>(Instant, Instant) = default;  // NOLINT(modernize-use-nullptr)
};

}  // namespace core
}  // namespace kairos
