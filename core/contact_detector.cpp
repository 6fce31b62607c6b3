#include "core/contact_detector.hpp"

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

}  // namespace core
}  // namespace kairos
