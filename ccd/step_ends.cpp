#include "ccd/step_ends.hpp"

#include "ccd/advancement.hpp"
#include "ccd/pair_overlap.hpp"
#include "ccd/shape_detector.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

/// Two shapes in a window, and looks at them at some times.
struct Look {
  const MovingShape& a;
  const MovingShape& b;
  const Window& window;

  [[nodiscard]] Overlap at(double t) const {
    return measure_overlap(a.shape, a.motion.pose(local(a, t)), b.shape,
                           b.motion.pose(local(b, t)));
  }
  /// Velocity of b's contact point against a's along the normal, m/s.
  [[nodiscard]] double parting_speed(double t, const Overlap& o) const {
    const auto velocity = [&](const MovingShape& m) {
      const double s = local(m, t);
      return m.motion.twist(s).at(o.point, m.motion.position(s));
    };
    return (velocity(b) - velocity(a)).dot(o.normal);
  }

 private:
  [[nodiscard]] double local(const MovingShape& m, double t) const {
    return (window.start + t) - m.motion.start;
  }
};

TimeOfImpact answer(ToiStatus status, double t, const Overlap& o, int evaluations) {
  return {.status = status,
          .t_lo = t,
          .t_hi = t,
          .gap = std::max(0.0, o.gap),
          .normal = o.normal,
          .witness_a = o.point - o.normal * (0.5 * o.gap),
          .witness_b = o.point + o.normal * (0.5 * o.gap),
          .evaluations = evaluations};
}

TimeOfImpact unbounded(const Window& window) {
  TimeOfImpact toi;
  toi.status = ToiStatus::undecided;
  toi.t_hi = window.duration;
  return toi;
}

class Linear final : public ShapeDetector {
 public:
  [[nodiscard]] DetectorInfo info() const override {
    return {.name = "linear",
            .locates = true,
            .proves = false,
            .summary = "looks at both ends of a step and draws a straight line between"};
  }

 private:
  [[nodiscard]] TimeOfImpact ordered_time_of_impact(const MovingShape& a, const MovingShape& b,
                                                    const Window& window,
                                                    double tolerance) const override {
    if (!std::isfinite(window.duration)) {
      return unbounded(window);
    }
    const double touch = tolerance > 0.0 ? tolerance : default_tolerance(a, b, window);
    const Look look{a, b, window};
    const Overlap start = look.at(0.0);
    // A pair that has just met, and parts, may overlap by roundoff.
    const bool leaving = start.gap >= -touch && look.parting_speed(0.0, start) >= 0.0;
    if (start.overlapping && !leaving) {
      return answer(ToiStatus::overlapping, 0.0, start, 1);
    }
    const Overlap end = look.at(window.duration);
    if (!end.overlapping || start.overlapping) {
      return answer(ToiStatus::separated, window.duration, end, 2);
    }
    const double t = window.duration * (start.gap / (start.gap - end.gap));
    return answer(ToiStatus::impact, t, look.at(t), 3);
  }
};

class CvodeRootfinding final : public ShapeDetector {
 public:
  [[nodiscard]] DetectorInfo info() const override {
    return {.name = "cvode-rootfinding",
            .locates = true,
            .proves = false,
            .summary = "SUNDIALS' own: changes of sign from step to step of cvode-*",
            .at_step_ends = true};
  }

 private:
  [[nodiscard]] TimeOfImpact ordered_time_of_impact(const MovingShape& a, const MovingShape& b,
                                                    const Window& window,
                                                    double tolerance) const override {
    if (!std::isfinite(window.duration)) {
      return unbounded(window);
    }
    // CVODE brackets a root to 100 roundoffs of its time and step [Hindmarsh2005].
    const double extent = std::min(smallest_extent(a.shape), smallest_extent(b.shape));
    const double touch = tolerance > 0.0 ? tolerance : 1e-9 * extent;
    const Look look{a, b, window};
    const Overlap start = look.at(0.0);
    if (start.gap < -touch) {
      return answer(ToiStatus::overlapping, 0.0, start, 1);
    }
    const Overlap end = look.at(window.duration);
    const bool met = std::abs(end.gap) <= touch && look.parting_speed(window.duration, end) < 0.0;
    if (!met) {
      return answer(ToiStatus::separated, window.duration, end, 2);
    }
    // Just before the end, where the motion is replaced.
    return answer(ToiStatus::impact, window.duration * (1.0 - 1e-12), end, 2);
  }
};

}  // namespace

std::unique_ptr<ContactDetector> make_linear() { return std::make_unique<Linear>(); }
std::unique_ptr<ContactDetector> make_cvode_rootfinding() {
  return std::make_unique<CvodeRootfinding>();
}

}  // namespace kairos::ccd
