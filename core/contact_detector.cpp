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

void ContactDetector::clear_times(const BallFlight& /*one*/, std::span<const BallFlight> /*others*/,
                                  double /*tolerance*/, std::span<double> clear) const {
  std::fill(clear.begin(), clear.end(), 0.0);
}

}  // namespace core
}  // namespace kairos
