#include "simulation/query_limits.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kairos {
inline namespace simulation {

std::string why_no_extent(double metres) {
  return metres >= smallest_extent
             ? std::string()
             : fmt::format("{} is no half-extent; allowed: numbers > 0, from {} (m)", metres,
                           smallest_extent);
}

std::string why_not_unit(double length) {
  return std::abs(length - 1.0) <= ccd::unit_tolerance
             ? std::string()
             : fmt::format("the quaternion has length {}; allowed: 1 within {}", length,
                           ccd::unit_tolerance);
}

std::string why_too_far(const Pose& pose, const Twist& twist, const Vector3& acceleration,
                        double duration) {
  const double reach = pose.position.norm() + twist.linear.norm() * duration +
                       0.5 * acceleration.norm() * duration * duration +
                       twist.angular.norm() * duration;
  return reach <= largest_magnitude
             ? std::string()
             : fmt::format(
                   "with this acceleration and duration leads beyond {}; allowed: motions "
                   "that stay within",
                   largest_magnitude);
}

std::string why_no_window(double seconds) {
  return seconds >= 0.0 ? std::string()
                        : fmt::format("{} is negative; allowed: numbers >= 0 (s)", seconds);
}

}  // namespace simulation
}  // namespace kairos
