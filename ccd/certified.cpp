#include "ccd/certified.hpp"

#include "ccd/advancement.hpp"
#include "ccd/ball_filter.hpp"
#include "ccd/closed_form.hpp"
#include "ccd/pair_overlap.hpp"
#include "ccd/shape_detector.hpp"
#include "ccd/sphere_plane.hpp"
#include "ccd/sphere_sphere.hpp"
#include "core/ball_detector.hpp"

namespace kairos::ccd {
namespace {

class Certified final : public ShapeDetector, public BallDetector {
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
  [[nodiscard]] std::optional<BallMeeting> ball_meeting(const BallFlight& a, const BallFlight& b,
                                                        const Window& window) const override {
    return sphere_sphere_meeting(a, b, window);
  }
  [[nodiscard]] Overlap ball_overlap(const Vector3& p_a, double radius_a, const Vector3& p_b,
                                     double radius_b) const override {
    return measure_overlap_of_balls(p_a, radius_a, p_b, radius_b);
  }
  [[nodiscard]] std::optional<TimeOfImpact> ball_meets_plane(const BallFlight& ball,
                                                             const HalfSpace& half_space,
                                                             const Pose& at_rest,
                                                             const Window& window) const override {
    return sphere_plane_impact(ball, half_space, at_rest, window);
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
