#pragma once

#include "core/contact_detector.hpp"

namespace kairos::ccd {

/// What all detectors of this room share: overlap at one instant, overlap of swept boxes, and the
/// end of a contact. They differ in how they look for its beginning.
class ShapeDetector : public ContactDetector {
 public:
  [[nodiscard]] bool overlaps(const Shape& a, const Pose& pose_a, const Shape& b,
                              const Pose& pose_b) const final;
  [[nodiscard]] Overlap overlap(const Shape& a, const Pose& pose_a, const Shape& b,
                                const Pose& pose_b) const final;
  [[nodiscard]] ContactManifold manifold(const Shape& a, const Pose& pose_a, const Shape& b,
                                         const Pose& pose_b, double reach) const final;
  [[nodiscard]] TimeOfImpact time_of_impact(const MovingShape& a, const MovingShape& b,
                                            const Window& window, double tolerance) const final;
  [[nodiscard]] TimeOfImpact time_of_separation(const MovingShape& a, const MovingShape& b,
                                                const Window& window, double tolerance) const final;
  [[nodiscard]] bool swept_overlap(const MovingShape& a, const MovingShape& b,
                                   const Window& window) const final;

 private:
  /// Shapes come in the order of their rank, and are never two half-spaces.
  [[nodiscard]] virtual TimeOfImpact ordered_time_of_impact(const MovingShape& a,
                                                            const MovingShape& b,
                                                            const Window& window,
                                                            double tolerance) const = 0;
};

/// The same answer with a and b exchanged.
[[nodiscard]] TimeOfImpact exchanged(TimeOfImpact toi);

}  // namespace kairos::ccd
