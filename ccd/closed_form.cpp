#include "ccd/closed_form.hpp"

#include "ccd/descent_answer.hpp"
#include "ccd/pair_overlap.hpp"
#include "ccd/relative_boxes.hpp"
#include "ccd/rounding/roundoff.hpp"
#include "ccd/shape_detector.hpp"
#include "ccd/sphere_plane.hpp"
#include "ccd/sphere_sphere.hpp"

#include <cmath>

namespace kairos::ccd {
namespace {

/// Whether the shapes do not overlap at these poses, could not in exact arithmetic, and are farther
/// apart than their error radii. For balls the closed forms show the rest: the overlap as computed
/// is enough.
bool clear_at_poses(const MovingShape& a, const Pose& pose_a, const MovingShape& b,
                    const Pose& pose_b) {
  const double radii = a.motion.error_radius + b.motion.error_radius;
  const auto* box = std::get_if<Box>(&a.shape);
  const auto* other = std::get_if<Box>(&b.shape);
  if (radii == 0.0 && box == nullptr && other == nullptr) {
    return !shapes_overlap(a.shape, pose_a, b.shape, pose_b);
  }
  if (radii == 0.0 && box != nullptr && other != nullptr) {
    return boxes_apart(RelativeBoxes(*box, pose_a, *other, pose_b));
  }
  const auto extent = [](const Shape& shape) {
    const double radius = bounding_radius(shape);
    return std::isfinite(radius) ? 2.0 * radius : 0.0;
  };
  const double size =
      (pose_b.position - pose_a.position).lpNorm<1>() + extent(a.shape) + extent(b.shape);
  return measure_overlap(a.shape, pose_a, b.shape, pose_b).gap - radii >
         24.0 * unit_roundoff * size;
}

}  // namespace

void retreat_from_overlap(const MovingShape& a, const MovingShape& b, const Window& window,
                          TimeOfImpact& toi) {
  if (toi.status == ToiStatus::overlapping) {
    return;
  }
  double back = ulp(toi.t_lo);
  for (int attempt = 0; attempt < most_retreats && toi.t_lo > 0.0; ++attempt) {
    const Pose pose_a = a.motion.pose(local_time(a.motion, window, toi.t_lo));
    const Pose pose_b = b.motion.pose(local_time(b.motion, window, toi.t_lo));
    if (clear_at_poses(a, pose_a, b, pose_b)) {
      return;
    }
    toi.t_lo = std::max(0.0, toi.t_lo - back);
    back *= 2.0;
  }
}

std::optional<TimeOfImpact> closed_form_impact(const MovingShape& a, const MovingShape& b,
                                               const Window& window) {
  auto toi = sphere_plane_impact(a, b, window);
  return toi ? toi : sphere_sphere_impact(a, b, window);
}

std::optional<TimeOfImpact> closed_form_separation(const MovingShape& a, const MovingShape& b,
                                                   const Window& window) {
  auto toi = sphere_plane_separation(a, b, window);
  return toi ? toi : sphere_sphere_separation(a, b, window);
}

}  // namespace kairos::ccd
