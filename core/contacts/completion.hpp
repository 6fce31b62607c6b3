#pragma once

#include "core/contacts/contact_system.hpp"

#include <span>
#include <vector>

namespace kairos {
inline namespace core {

/// A point where two bodies of a group touch, and may push each other.
struct PushPoint {
  std::size_t a = 0;  ///< places in the group
  std::size_t b = 0;
  Vector3 point = Vector3::Zero();   ///< world frame, m
  Vector3 normal = Vector3::Zero();  ///< unit, from a to b
  double friction = 0.0;             ///< Coulomb's; may be infinite
};

/// By how much bodies would have to be pulled for their velocities to change from `before` to
/// `after`, m/s: what is left of the change, of a body's velocity or of its spin times its
/// `radius`, by the impulses at these points that come nearest to it. Those press, and are within
/// their friction cones.
[[nodiscard]] double pulled(const std::vector<GroupBody>& bodies, std::span<const double> radius,
                            std::span<const PushPoint> points, std::span<const Twist> before,
                            std::span<const Twist> after, const GroupJoints* joints = nullptr);

}  // namespace core
}  // namespace kairos
