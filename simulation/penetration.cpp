#include "simulation/penetration.hpp"

#include "simulation/registry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace simulation {
namespace {

/// Extent that scales roundoff: a half-space has none of its own.
double finite_radius(const Shape& shape) {
  const double radius = bounding_radius(shape);
  return std::isfinite(radius) ? radius : 0.0;
}

/// Whether a ball of this radius about the origin of a body is above a half-space by far more than
/// roundoff.
bool clear_of(const Shape& shape, const Pose& pose, const Vector3& origin, double radius) {
  const auto* half_space = std::get_if<HalfSpace>(&shape);
  if (half_space == nullptr) {
    return false;
  }
  const Vector3 up = half_space_normal(*half_space, pose);
  const double sizes = origin.lpNorm<1>() + pose.position.lpNorm<1>() + radius;
  return up.dot(origin - pose.position) > radius + 1e-9 * sizes;
}

/// Nearest points of cylinders and cones come from a search, and are some more roundings off.
bool is_round(const Shape& shape) {
  return std::holds_alternative<Cylinder>(shape) || std::holds_alternative<Cone>(shape);
}

bool held(BodyIndex a, BodyIndex b, std::span<const char> in_hand) {
  return !in_hand.empty() && (in_hand[a] != 0 || in_hand[b] != 0);
}

}  // namespace

PenetrationProbe::PenetrationProbe(const Model& model)
    : model_(model), detector_(find_detector("certified")) {
  if (!model.asks_every_pair()) {
    constexpr double default_tolerance = 0.0;
    neighbourhood_ = find_neighbourhood(model.broad_phase())(model, default_tolerance);
  }
}

bool PenetrationProbe::finite(BodyIndex i) const {
  return std::isfinite(bounding_radius(model_.shape(i)));
}

bool PenetrationProbe::can_penetrate(BodyIndex a, BodyIndex b) const {
  return !model_.is_field(a) && !model_.is_field(b) && model_.interacts(a, b);
}

/// Pairs that are near each other, those that could penetrate among them, in the order of the
/// model's, until `visit` says that it is enough.
template <typename Visit>
void PenetrationProbe::for_each_near_pair(std::span<const BodyState> bodies,
                                          const Visit& visit) const {
  if (!neighbourhood_) {
    for (const auto& [a, b] : model_.pairs()) {
      if (!visit(a, b)) {
        return;
      }
    }
    return;
  }
  for (BodyIndex i = 0; i < model_.size(); ++i) {
    const Motion still = Motion::at_rest(Instant{}, bodies[i].pose);
    neighbourhood_->enter(i, {model_.shape(i), still}, Instant{}, Instant::never());
  }
  std::vector<Neighbour> near;
  for (BodyIndex a = 0; a < model_.size(); ++a) {
    near.clear();
    neighbourhood_->near(a, near);
    std::erase_if(near, [a](const Neighbour& b) { return b.body <= a; });
    std::sort(near.begin(), near.end(),
              [](const Neighbour& x, const Neighbour& y) { return x.body < y.body; });
    for (const Neighbour& b : near) {
      if (!visit(a, b.body)) {
        return;
      }
    }
  }
}

double PenetrationProbe::depth(BodyIndex a, const Pose& pose_a, BodyIndex b,
                               const Pose& told_b) const {
  if (!can_penetrate(a, b)) {
    return 0.0;
  }
  Pose pose_b = told_b;
  if (const auto& box = model_.scene().periodic; box && finite(a) && finite(b)) {
    pose_b.position += box->shift(box->nearest(told_b.position - pose_a.position));
  }
  const Shape& shape_a = model_.shape(a);
  const Shape& shape_b = model_.shape(b);
  const double radius_a = bounding_radius(shape_a);
  const double radius_b = bounding_radius(shape_b);
  if ((pose_a.position - pose_b.position).norm() > radius_a + radius_b ||
      clear_of(shape_a, pose_a, pose_b.position, radius_b) ||
      clear_of(shape_b, pose_b, pose_a.position, radius_a)) {
    return 0.0;
  }
  const double gap = detector_->overlap(shape_a, pose_a, shape_b, pose_b).gap;
  const double scale = pose_a.position.norm() + pose_b.position.norm() + finite_radius(shape_a) +
                       finite_radius(shape_b);
  const double roundings = is_round(shape_a) || is_round(shape_b) ? 64.0 : 16.0;
  const double touching = roundings * std::numeric_limits<double>::epsilon() * scale;
  return gap < -touching ? -gap : 0.0;
}

std::optional<Penetration> PenetrationProbe::deepest(std::span<const BodyState> bodies,
                                                     std::span<const char> in_hand) const {
  Penetration found;
  for_each_near_pair(bodies, [&](BodyIndex a, BodyIndex b) {
    const double d = held(a, b, in_hand) ? 0.0 : depth(a, bodies[a].pose, b, bodies[b].pose);
    if (d > found.depth) {
      found = {{a, b}, d};
    }
    return true;
  });
  return found.depth > 0.0 ? std::optional(found) : std::nullopt;
}

std::optional<Penetration> PenetrationProbe::first(std::span<const BodyState> bodies,
                                                   std::span<const char> in_hand) const {
  std::optional<Penetration> found;
  for_each_near_pair(bodies, [&](BodyIndex a, BodyIndex b) {
    const double d = held(a, b, in_hand) ? 0.0 : depth(a, bodies[a].pose, b, bodies[b].pose);
    if (d > 0.0) {
      found = Penetration{{a, b}, d};
    }
    return !found;
  });
  return found;
}

}  // namespace simulation
}  // namespace kairos
