#include "ccd/shape_detector.hpp"

#include "ccd/advancement.hpp"
#include "ccd/closed_form.hpp"
#include "ccd/contact_manifold.hpp"
#include "ccd/pair_overlap.hpp"
#include "ccd/query_check.hpp"
#include "ccd/swept_box.hpp"

#include <limits>
#include <utility>

namespace kairos::ccd {
namespace {

bool in_order(const Shape& a, const Shape& b) { return shape_rank(a) <= shape_rank(b); }

bool both_half_spaces(const Shape& a, const Shape& b) {
  return std::holds_alternative<HalfSpace>(a) && std::holds_alternative<HalfSpace>(b);
}

TimeOfImpact never(const Window& window) {
  TimeOfImpact toi;
  toi.t_lo = toi.t_hi = window.duration;
  return toi;
}

/// Nothing is proven.
TimeOfImpact unknown() {
  TimeOfImpact toi;
  toi.status = ToiStatus::undecided;
  toi.gap = std::numeric_limits<double>::infinity();
  return toi;
}

}  // namespace

TimeOfImpact exchanged(TimeOfImpact toi) {
  toi.normal = -toi.normal;
  std::swap(toi.witness_a, toi.witness_b);
  return toi;
}

bool ShapeDetector::overlaps(const Shape& a, const Pose& pose_a, const Shape& b,
                             const Pose& pose_b) const {
  check_poses(a, pose_a, b, pose_b);
  return shapes_overlap(a, pose_a, b, pose_b);
}

Overlap ShapeDetector::overlap(const Shape& a, const Pose& pose_a, const Shape& b,
                               const Pose& pose_b) const {
  check_poses(a, pose_a, b, pose_b);
  return measure_overlap(a, pose_a, b, pose_b);
}

ContactManifold ShapeDetector::manifold(const Shape& a, const Pose& pose_a, const Shape& b,
                                        const Pose& pose_b, double reach) const {
  return contact_manifold(a, pose_a, b, pose_b, reach);
}

TimeOfImpact ShapeDetector::time_of_impact(const MovingShape& a, const MovingShape& b,
                                           const Window& window, double tolerance) const {
  check_query(a, b, window, tolerance);
  if (both_half_spaces(a.shape, b.shape)) {
    return never(window);
  }
  if (!within_range(a, b, window)) {
    return unknown();
  }
  return in_order(a.shape, b.shape) ? ordered_time_of_impact(a, b, window, tolerance)
                                    : exchanged(ordered_time_of_impact(b, a, window, tolerance));
}

TimeOfImpact ShapeDetector::time_of_separation(const MovingShape& a, const MovingShape& b,
                                               const Window& window, double tolerance) const {
  check_query(a, b, window, tolerance);
  if (both_half_spaces(a.shape, b.shape)) {
    return never(window);
  }
  if (!within_range(a, b, window)) {
    return unknown();
  }
  const auto ordered = [&](const MovingShape& first, const MovingShape& second) {
    const auto toi = closed_form_separation(first, second, window);
    return toi ? *toi : advance_to_separation(first, second, window, tolerance);
  };
  return in_order(a.shape, b.shape) ? ordered(a, b) : exchanged(ordered(b, a));
}

bool ShapeDetector::swept_overlap(const MovingShape& a, const MovingShape& b,
                                  const Window& window) const {
  check_query(a, b, window, 0.0);
  if (!within_range(a, b, window)) {
    return true;  // nothing is proven free
  }
  return in_order(a.shape, b.shape) ? swept_shapes_overlap(a, b, window)
                                    : swept_shapes_overlap(b, a, window);
}

}  // namespace kairos::ccd
