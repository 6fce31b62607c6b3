#include "core/impact_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Rounding error of the velocity of the contact point, m/s. The arm is a difference of
/// coordinates, and is known no better than they are.
double rounding(const BodyState& body, const Contact& contact) {
  const double arm = (contact.point - body.pose.position).norm() + body.pose.position.norm();
  return 64.0 * epsilon * body.twist.linear.norm() +
         1024.0 * epsilon * body.twist.angular.norm() * arm;
}

}  // namespace

std::string broken_restitution(const Event& impact, double e, double handed_on) {
  const Contact& contact = impact.contact;
  const double approach = normal_velocity(contact, impact.before_a, impact.before_b);
  const double after = normal_velocity(contact, impact.after_a, impact.after_b);
  const double roundoff = handed_on + rounding(impact.before_a, contact) +
                          rounding(impact.before_b, contact) + rounding(impact.after_a, contact) +
                          rounding(impact.after_b, contact);
  if (approach > roundoff) {
    return fmt::format("an impact of two that part at {:.3g} m/s", approach);
  }
  if (!(std::abs(after + e * approach) <= roundoff)) {
    return fmt::format("a rebound of {:.17g} m/s from {:.17g} m/s, with restitution {}", after,
                       approach, e);
  }
  return {};
}

}  // namespace core
}  // namespace kairos
