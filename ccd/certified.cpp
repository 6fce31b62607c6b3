#include "ccd/certified.hpp"

#include "ccd/advancement.hpp"
#include "ccd/ball_filter.hpp"
#include "ccd/closed_form.hpp"
#include "ccd/shape_detector.hpp"
#include "ccd/sphere_sphere.hpp"

namespace kairos::ccd {
namespace {

class Certified final : public ShapeDetector {
 public:
  [[nodiscard]] DetectorInfo info() const override {
    return {.name = "certified",
            .locates = true,
            .proves = true,
            .summary = "closed forms and advancement, ending in a proven bracket"};
  }

  [[nodiscard]] std::optional<TimeOfImpact> ball_impact(const BallFlight& a, const BallFlight& b,
                                                        const Window& window) const override {
    return sphere_sphere_impact(a, b, window);
  }
  void clear_times(const FlightsBeside& balls, double tolerance,
                   std::span<double> clear) const override {
    filter_balls(balls, tolerance, clear);
  }

 private:
  [[nodiscard]] TimeOfImpact ordered_time_of_impact(const MovingShape& a, const MovingShape& b,
                                                    const Window& window,
                                                    double tolerance) const override {
    if (const auto toi = closed_form_impact(a, b, window)) {
      return *toi;
    }
    return advance_to_impact(a, b, window, {.tolerance = tolerance, .prove = true});
  }
};

}  // namespace

std::unique_ptr<ContactDetector> make_certified() { return std::make_unique<Certified>(); }

}  // namespace kairos::ccd
