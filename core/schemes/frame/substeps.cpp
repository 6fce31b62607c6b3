#include "core/schemes/frame/substeps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace kairos {
inline namespace core {

double default_threshold(const Model& model) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : model.pairs()) {
    if (model.is_field(a) || model.is_field(b)) {
      continue;
    }
    double sum = 0.0;
    for (const BodyIndex i : {a, b}) {
      const double extent = smallest_extent(model.shape(i));
      sum += std::isfinite(extent) ? extent : 0.0;  // a half-space cannot be jumped over
    }
    smallest = std::min(smallest, sum);
  }
  return 0.5 * smallest;
}

SubstepPlan::SubstepPlan(const Model& model, const SchemeOptions& options)
    : threshold_(options.threshold > 0.0 ? options.threshold : default_threshold(model)),
      equal_(options.equal_substeps),
      most_(options.max_substeps) {}

void SubstepPlan::begin_frame(double frame) {
  frame_ = frame;
  part_ = 0.0;
  taken_ = 0;
}

double SubstepPlan::next(FrameWorld& world, double left) {
  const double ratio = world.largest_movement() / threshold_;
  if (!(ratio <= static_cast<double>(most_)) || ++taken_ > most_) {
    world.stop("substeps: a frame would take more than " + std::to_string(most_) +
               " substeps; raise the threshold or shorten the frame");
    return 0.0;
  }
  if (equal_) {
    if (part_ == 0.0) {
      part_ = frame_ / std::max(1.0, std::ceil(ratio));
    }
    // The last part takes what rounding left.
    return left < 1.5 * part_ ? left : part_;
  }
  return ratio > 1.0 ? left / ratio : left;
}

}  // namespace core
}  // namespace kairos
