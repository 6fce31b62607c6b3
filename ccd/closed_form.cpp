#include "ccd/closed_form.hpp"

#include "ccd/descent_answer.hpp"
#include "ccd/pair_overlap.hpp"
#include "ccd/shape_detector.hpp"
#include "ccd/sphere_plane.hpp"
#include "ccd/sphere_sphere.hpp"

namespace kairos::ccd {

void retreat_from_overlap(const MovingShape& a, const MovingShape& b, const Window& window,
                          TimeOfImpact& toi) {
  if (toi.status == ToiStatus::overlapping) {
    return;
  }
  double back = ulp(toi.t_lo);
  for (int attempt = 0; attempt < 40 && toi.t_lo > 0.0; ++attempt) {
    const Pose pose_a = a.motion.pose(local_time(a.motion, window, toi.t_lo));
    const Pose pose_b = b.motion.pose(local_time(b.motion, window, toi.t_lo));
    if (!shapes_overlap(a.shape, pose_a, b.shape, pose_b)) {
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
