#include "ccd/bisection.hpp"

#include "ccd/advancement.hpp"
#include "ccd/pair_motion.hpp"
#include "ccd/pair_overlap.hpp"
#include "ccd/rounding/roundoff.hpp"
#include "ccd/shape_detector.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr int most_looks = 20'000;  ///< of one query; what is beyond is `undecided`

/// One query: the shapes at any time of the window.
class Bisection {
 public:
  Bisection(const MovingShape& a, const MovingShape& b, const Window& window, double tolerance)
      : a_(a), b_(b), window_(window), motion_(a, b, window) {
    tolerance_ = tolerance > 0.0 ? tolerance : default_tolerance(a, b, window);
    threshold_ = 0.5 * std::min(smallest_extent(a.shape), smallest_extent(b.shape));
  }

  TimeOfImpact run() {
    const Overlap start = look(0.0);
    if (start.overlapping && !leaving(start)) {
      const bool touching = start.gap >= -tolerance_;
      return answer(touching ? ToiStatus::impact : ToiStatus::overlapping, 0.0, 0.0, start);
    }
    const double duration = motion_.duration();
    double t = 0.0;
    bool in_touch = start.overlapping;  // all the time since the start, as far as looks tell
    while (t < duration) {
      const double step = limited_step(t);
      if (!(t + step > t) || toi_.evaluations >= most_looks) {
        return answer(ToiStatus::undecided, t, duration, look(t));
      }
      last_step_ = step;
      const double next = std::min(duration, t + step);
      const bool inside = overlaps(next);
      if (inside && !in_touch) {
        return bisect(t, next);
      }
      if (inside && look(next).gap < -tolerance_) {
        return return_to_touch(t, next, start);
      }
      in_touch = inside;
      t = next;
      if (gone_for_good(t)) {
        break;
      }
    }
    toi_.t_lo = toi_.t_hi = duration;
    return toi_;
  }

 private:
  Overlap look(double t) {
    ++toi_.evaluations;
    return measure_overlap(a_.shape, pose(a_.motion, t), b_.shape, pose(b_.motion, t));
  }
  bool overlaps(double t) {
    ++toi_.evaluations;
    return shapes_overlap(a_.shape, pose(a_.motion, t), b_.shape, pose(b_.motion, t));
  }
  Pose pose(const Motion& motion, double t) const {
    return motion.pose((window_.start + t) - motion.start);
  }

  /// Whether the two touch to roundoff, and the contact point of b does not approach a.
  bool leaving(const Overlap& start) const {
    if (start.gap < -tolerance_) {
      return false;
    }
    const double s_a = window_.start - a_.motion.start;
    const double s_b = window_.start - b_.motion.start;
    const Vector3 velocity = b_.motion.twist(s_b).at(start.point, b_.motion.position(s_b)) -
                             a_.motion.twist(s_a).at(start.point, a_.motion.position(s_a));
    return velocity.dot(start.normal) >= 0.0;
  }

  /// Fig. 15: the time in which nothing moves by more than the threshold.
  double limited_step(double t) {
    motion_.evaluate(t, k_);
    const double remaining = motion_.duration() - t;
    double step = last_step_ > 0.0 ? std::min(remaining, 4.0 * last_step_)
                                   : (std::isfinite(remaining) ? remaining : 1.0);
    for (int attempt = 0; attempt < 200; ++attempt) {
      const double moved = motion_.speed_bound(k_, motion_.bounds(t, step), step) * step;
      if (moved <= threshold_) {
        // A step may grow where motions are slow; a body at rest needs one look at the end.
        return moved < 0.25 * threshold_ && step < remaining ? grown(t, step, remaining) : step;
      }
      step *= std::max(0.1, 0.9 * threshold_ / moved);
    }
    return 0.0;
  }
  double grown(double t, double step, double remaining) {
    while (step < remaining) {
      const double longer = std::min(2.0 * step, remaining);
      if (!(motion_.speed_bound(k_, motion_.bounds(t, longer), longer) * longer <= threshold_)) {
        break;
      }
      step = longer;
    }
    return step;
  }

  /// Whether, in an unbounded window, the balls around the bodies only move apart from here on.
  bool gone_for_good(double t) {
    if (std::isfinite(motion_.duration()) || !motion_.simple()) {
      return false;
    }
    motion_.evaluate(t, k_);
    const bool plane = std::holds_alternative<HalfSpace>(b_.shape);
    if (plane && motion_.turns_b()) {
      return false;
    }
    const Vector3 n = plane ? Vector3(-k_.R_WB.col(1)) : Vector3(k_.d.normalized());
    const double gap = n.dot(k_.d) - motion_.radius_a() - motion_.radius_b() - motion_.reach();
    return gap > 0.0 && n.dot(k_.v) >= 0.0 && n.dot(k_.c) >= 0.0;
  }

  TimeOfImpact bisect(double outside, double inside) {
    while (true) {
      const double middle = outside + 0.5 * (inside - outside);
      if (!(middle > outside && middle < inside)) {
        break;
      }
      (overlaps(middle) ? inside : outside) = middle;
    }
    return answer(ToiStatus::impact, outside, inside, look(outside));
  }

  /// They were in touch until `outside`, and go into each other until `inside`: after a hop that
  /// no look saw, or as they are pressed together.
  TimeOfImpact return_to_touch(double outside, double inside, const Overlap& start) {
    const double begin = outside;
    while (true) {
      const double middle = outside + 0.5 * (inside - outside);
      if (!(middle > outside && middle < inside)) {
        break;
      }
      if (!overlaps(middle)) {
        return bisect(middle, inside);
      }
      (look(middle).gap < -tolerance_ ? inside : outside) = middle;
    }
    return begin > 0.0 ? answer(ToiStatus::impact, outside, inside, look(outside))
                       : answer(ToiStatus::impact, 0.0, 0.0, start);
  }

  TimeOfImpact answer(ToiStatus status, double t_lo, double t_hi, const Overlap& at) {
    toi_.status = status;
    toi_.t_lo = t_lo;
    toi_.t_hi = t_hi;
    toi_.gap = std::max(0.0, at.gap);
    toi_.normal = at.normal;
    toi_.witness_a = at.point - at.normal * (0.5 * at.gap);
    toi_.witness_b = at.point + at.normal * (0.5 * at.gap);
    return toi_;
  }

  MovingShape a_;
  MovingShape b_;
  Window window_;
  PairMotion motion_;
  Kinematics k_;
  double tolerance_ = 0.0;
  double threshold_ = 0.0;
  double last_step_ = 0.0;  ///< s
  TimeOfImpact toi_;
};

class BisectionDetector final : public ShapeDetector {
 public:
  [[nodiscard]] DetectorInfo info() const override {
    return {.name = "bisection",
            .locates = true,
            .proves = false,
            .summary = "looks at limited movements, then bisects (thesis, fig. 15)"};
  }

 private:
  [[nodiscard]] TimeOfImpact ordered_time_of_impact(const MovingShape& a, const MovingShape& b,
                                                    const Window& window,
                                                    double tolerance) const override {
    return Bisection(a, b, window, tolerance).run();
  }
};

}  // namespace

std::unique_ptr<ContactDetector> make_bisection() { return std::make_unique<BisectionDetector>(); }

}  // namespace kairos::ccd
