#include "core/impact_law.hpp"

namespace kairos {
inline namespace core {

double normal_velocity(const Contact& contact, const BodyState& a, const BodyState& b) {
  const Vector3 of_a = a.twist.at(contact.point, a.pose.position);
  const Vector3 of_b = b.twist.at(contact.point, b.pose.position);
  return contact.normal.dot(of_b - of_a);
}

}  // namespace core
}  // namespace kairos
