#include "core/contact_detector.hpp"

#include <algorithm>

namespace kairos {
inline namespace core {

ContactManifold ContactDetector::manifold(const Shape& a, const Pose& pose_a, const Shape& b,
                                          const Pose& pose_b, double reach) const {
  const Overlap o = overlap(a, pose_a, b, pose_b);
  ContactManifold manifold;
  manifold.normal = o.normal;
  if (o.gap <= reach) {
    manifold.add(o.point, o.gap);
  }
  return manifold;
}

std::optional<TimeOfImpact> ContactDetector::ball_impact(const BallFlight& /*a*/,
                                                         const BallFlight& /*b*/,
                                                         const Window& /*window*/) const {
  return std::nullopt;
}

void ContactDetector::clear_times(const FlightsBeside& balls, double /*tolerance*/,
                                  std::span<double> clear) const {
  std::fill_n(clear.begin(), balls.size(), 0.0);
}

}  // namespace core
}  // namespace kairos
