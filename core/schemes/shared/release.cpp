#include "core/schemes/shared/release.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

/// Overlap that roundoff can account for, m; a half-space has no extent of its own.
double touching(const Shape& shape_a, const Pose& a, const Shape& shape_b, const Pose& b) {
  double scale = a.position.norm() + b.position.norm();
  for (const double radius : {bounding_radius(shape_a), bounding_radius(shape_b)}) {
    scale += std::isfinite(radius) ? radius : 0.0;
  }
  return 16.0 * std::numeric_limits<double>::epsilon() * scale;
}

}  // namespace

std::string why_not_released(const SchemeRun& run, const Grasps& grasps, const Grip& grip,
                             Instant t, const std::function<Pose(BodyIndex)>& pose) {
  const Model& model = run.model;
  const Pose at = pose(grip.held);
  const Shape& shape = model.shape(grip.held);
  for (BodyIndex i = 0; i < model.size(); ++i) {
    if (i == grip.hand || i == grip.held || model.is_field(i) || grasps.in_hand()[i] != 0 ||
        !model.interacts(grip.held, i)) {
      continue;
    }
    const Pose other = pose(i);
    const double gap = run.detector.overlap(shape, at, model.shape(i), other).gap;
    if (gap < -touching(shape, at, model.shape(i), other)) {
      return fmt::format(
          "hand: '{1}', which '{0}' has let go of, is {2:.3g} m inside '{3}' at t = {4} s; it must "
          "be released where it is apart from solids or touches them",
          model.body(grip.hand).name, model.body(grip.held).name, -gap, model.body(i).name,
          t.seconds);
    }
  }
  return {};
}

}  // namespace core
}  // namespace kairos
