#include "ccd/sat.hpp"

#include "ccd/pair_overlap.hpp"
#include "ccd/shape_detector.hpp"

namespace kairos::ccd {
namespace {

class Sat final : public ShapeDetector {
 public:
  [[nodiscard]] DetectorInfo info() const override {
    return {.name = "sat",
            .locates = false,
            .proves = false,
            .summary = "separating axes (15 for two boxes) at one instant"};
  }

 private:
  [[nodiscard]] TimeOfImpact ordered_time_of_impact(const MovingShape& a, const MovingShape& b,
                                                    const Window& window,
                                                    double /*tolerance*/) const override {
    const Overlap now = measure_overlap(a.shape, a.motion.pose(window.start - a.motion.start),
                                        b.shape, b.motion.pose(window.start - b.motion.start));
    TimeOfImpact toi;
    toi.evaluations = 1;
    toi.normal = now.normal;
    if (now.overlapping) {
      toi.status = ToiStatus::overlapping;
      toi.witness_a = now.point - now.normal * (0.5 * now.gap);
      toi.witness_b = now.point + now.normal * (0.5 * now.gap);
    } else {
      toi.t_lo = toi.t_hi = window.duration;
    }
    return toi;
  }
};

}  // namespace

std::unique_ptr<ContactDetector> make_sat() { return std::make_unique<Sat>(); }

}  // namespace kairos::ccd
