#pragma once

#include "ccd/query_check.hpp"
#include "core/pose.hpp"

#include <string>

namespace kairos {
inline namespace simulation {

// The numbers that a query about two bodies may hold, as a row of a file or as arrays: those that
// detectors accept. Each function returns what is wrong; empty: nothing is.

/// Largest magnitude of any number but times, and of any distance that a motion leads to.
inline constexpr double largest_magnitude = ccd::greatest_size;
/// Smallest half-extent or radius, m.
inline constexpr double smallest_extent = ccd::least_extent;
/// Squares of times are finite, s.
inline constexpr double longest_duration_asked = 1e150;

/// Of a half-extent or a radius, m.
[[nodiscard]] std::string why_no_extent(double metres);
/// Of an orientation as written, by its length.
[[nodiscard]] std::string why_not_unit(double length);
/// Of p + v t + a t^2/2 and a turn at a constant rate, over the whole window.
[[nodiscard]] std::string why_too_far(const Pose& pose, const Twist& twist,
                                      const Vector3& acceleration, double duration);
/// Of the length of the window, s.
[[nodiscard]] std::string why_no_window(double seconds);

}  // namespace simulation
}  // namespace kairos
