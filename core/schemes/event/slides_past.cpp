#include "core/schemes/event/slides_past.hpp"

#include "core/contacts/touch.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// What slides past an edge of another is left alone on so much of its extent.
constexpr double past_edges = 1e-6;

/// Whether the plane of a face of `own` separates it, up to rounding, from the other, whose corners
/// come no nearer to it; `later`: only whether it separates them.
bool separates(const TouchFeature& face, const BodyState& own,
               std::span<const TouchFeature> corners, const BodyState& other, bool later) {
  const Vector3 n = own.pose.orientation * face.direction;
  const Vector3 on = own.pose.to_world(face.at);
  const double rounding = 16.0 * 12.0 * epsilon * (on.norm() + other.pose.position.norm());
  for (const TouchFeature& corner : corners) {
    const Vector3 x = other.pose.to_world(corner.at) - corner.radius * n;
    const double above = n.dot(x - on);
    if (above < -rounding) {
      return false;
    }
    if (!later && above <= rounding) {
      const Vector3 v = other.twist.at(x, other.pose.position) - own.twist.at(x, own.pose.position);
      if (n.dot(v) < -16.0 * epsilon * v.norm()) {
        return false;
      }
    }
  }
  return true;
}

/// A body at an instant and a little later.
struct Passing {
  const Shape& shape;
  const BodyState& now;
  BodyState later;
};

bool separates_any(const Passing& own, const Passing& other,
                   std::span<const TouchFeature> corners) {
  const std::vector<TouchFeature> faces = faces_of(own.shape);
  return std::any_of(faces.begin(), faces.end(), [&](const TouchFeature& face) {
    return separates(face, own.now, corners, other.now, false) &&
           separates(face, own.later, corners, other.later, true);
  });
}

}  // namespace

double slides_past(const MovingShape& a, const BodyState& at_a, const MovingShape& b,
                   const BodyState& at_b, Instant t) {
  const auto corners_a = corners_of(a.shape);
  const auto corners_b = corners_of(b.shape);
  // A half-space has no corners, and no edge that could be met by chance.
  if (!corners_a || !corners_b || corners_a->empty() || corners_b->empty()) {
    return 0.0;
  }
  const double speed = (at_b.twist.linear - at_a.twist.linear).norm() +
                       at_a.twist.angular.norm() * bounding_radius(a.shape) +
                       at_b.twist.angular.norm() * bounding_radius(b.shape);
  double duration =
      past_edges * std::min(smallest_extent(a.shape), smallest_extent(b.shape)) / speed;
  for (const MovingShape* const moving : {&a, &b}) {
    duration = std::min(duration, moving->motion.duration - (t - moving->motion.start));
  }
  if (!(duration > 0.0)) {
    return 0.0;
  }
  const auto later = [&](const MovingShape& moving) {
    const double s = t - moving.motion.start + duration;
    return BodyState{moving.motion.pose(s), moving.motion.twist(s)};
  };
  const Passing own{a.shape, at_a, later(a)};
  const Passing other{b.shape, at_b, later(b)};
  return separates_any(own, other, *corners_b) || separates_any(other, own, *corners_a) ? duration
                                                                                        : 0.0;
}

}  // namespace core
}  // namespace kairos
