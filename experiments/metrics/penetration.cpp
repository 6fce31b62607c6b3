#include "experiments/metrics/penetration.hpp"

#include "experiments/registry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos::experiments {
namespace {

/// Extent that scales roundoff: a half-space has none of its own.
double finite_radius(const Shape& shape) {
  const double radius = bounding_radius(shape);
  return std::isfinite(radius) ? radius : 0.0;
}

bool held(const BodyPair& pair, std::span<const char> in_hand) {
  return !in_hand.empty() && (in_hand[pair.first] != 0 || in_hand[pair.second] != 0);
}

}  // namespace

PenetrationProbe::PenetrationProbe(const Model& model)
    : model_(model), detector_(find_detector("certified")) {
  for (const BodyPair& pair : model.pairs()) {
    const auto [a, b] = pair;
    const bool solids = !model.is_field(a) && !model.is_field(b);
    if (solids && (model.is_free(a) || model.is_free(b))) {
      pairs_.push_back({pair, bounding_radius(model.shape(a)) + bounding_radius(model.shape(b))});
    }
  }
}

double PenetrationProbe::depth(const Pair& pair, std::span<const BodyState> bodies) const {
  const auto [a, b] = pair.bodies;
  const Pose& pose_a = bodies[a].pose;
  const Pose& pose_b = bodies[b].pose;
  if ((pose_a.position - pose_b.position).norm() > pair.reach) {
    return 0.0;
  }
  const Shape& shape_a = model_.shape(a);
  const Shape& shape_b = model_.shape(b);
  const double gap = detector_->overlap(shape_a, pose_a, shape_b, pose_b).gap;
  const double scale = pose_a.position.norm() + pose_b.position.norm() + finite_radius(shape_a) +
                       finite_radius(shape_b);
  const double touching = 16.0 * std::numeric_limits<double>::epsilon() * scale;
  return gap < -touching ? -gap : 0.0;
}

std::optional<Penetration> PenetrationProbe::deepest(std::span<const BodyState> bodies,
                                                     std::span<const char> in_hand) const {
  Penetration found;
  for (const Pair& pair : pairs_) {
    const double d = held(pair.bodies, in_hand) ? 0.0 : depth(pair, bodies);
    if (d > found.depth) {
      found = {pair.bodies, d};
    }
  }
  return found.depth > 0.0 ? std::optional(found) : std::nullopt;
}

std::optional<Penetration> PenetrationProbe::first(std::span<const BodyState> bodies,
                                                   std::span<const char> in_hand) const {
  for (const Pair& pair : pairs_) {
    const double d = held(pair.bodies, in_hand) ? 0.0 : depth(pair, bodies);
    if (d > 0.0) {
      return Penetration{pair.bodies, d};
    }
  }
  return std::nullopt;
}

}  // namespace kairos::experiments
