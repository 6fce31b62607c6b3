#include "ccd/conservative_advancement.hpp"

#include "ccd/advancement.hpp"
#include "ccd/shape_detector.hpp"

namespace kairos::ccd {
namespace {

class ConservativeAdvancement final : public ShapeDetector {
 public:
  [[nodiscard]] DetectorInfo info() const override {
    return {.name = "conservative-advancement",
            .locates = true,
            .proves = false,
            .summary = "steps that cannot pass a contact, until the gap is within tolerance"};
  }

 private:
  [[nodiscard]] TimeOfImpact ordered_time_of_impact(const MovingShape& a, const MovingShape& b,
                                                    const Window& window,
                                                    double tolerance) const override {
    return advance_to_impact(a, b, window, {.tolerance = tolerance, .prove = false});
  }
};

}  // namespace

std::unique_ptr<ContactDetector> make_conservative_advancement() {
  return std::make_unique<ConservativeAdvancement>();
}

}  // namespace kairos::ccd
