#include "core/schemes/event/draws_apart.hpp"

#include "core/contacts/touch.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace kairos {
inline namespace core {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Roundoff of a point of a body, of the sizes that it is a sum of.
constexpr double roundoff = 64.0 * epsilon;

bool is_half_space(const Shape& shape) { return std::holds_alternative<HalfSpace>(shape); }

/// How far a body reaches along m; a half-space: along its normal.
double reach(const Vector3& m, const Shape& shape, std::span<const TouchFeature> corners,
             const Pose& pose) {
  if (is_half_space(shape)) {
    return m.dot(pose.position);
  }
  double farthest = -std::numeric_limits<double>::infinity();
  for (const TouchFeature& corner : corners) {
    farthest = std::max(farthest, m.dot(pose.to_world(corner.at)) + corner.radius);
  }
  return farthest;
}

/// What bounds the way of two bodies from t on.
struct Way {
  double longest = std::numeric_limits<double>::infinity();  ///< as long as both motions last, s
  double speed = 0.0;      ///< of their points, relative to each other, m/s
  double curvature = 0.0;  ///< the same of their accelerations, as one of them sees it, m/s^2
  double rounding = 0.0;   ///< m

  Way(const MovingShape& own, const MovingShape& other, Instant t) {
    double turning = 0.0;
    double radii = 0.0;
    for (const MovingShape* const moving : {&own, &other}) {
      const double s = t - moving->motion.start;
      const Twist v = moving->motion.twist(s);
      longest = std::min(longest, moving->motion.duration - s);
      speed += v.linear.norm();
      turning += v.angular.norm();
      radii += is_half_space(moving->shape) ? 0.0 : bounding_radius(moving->shape);
      curvature += moving->motion.acceleration(s).norm();
      rounding += roundoff * moving->motion.pose(s).position.norm();
    }
    rounding += roundoff * radii;
    // Of a point of the one about the middle of the other.
    const double around = 2.0 * turning * radii;
    curvature += turning * (2.0 * speed + around);
    speed += around;
  }
};

}  // namespace

double draws_apart(const MovingShape& own, const MovingShape& other, const Vector3& n, Instant t) {
  const auto own_corners = corners_of(own.shape);
  const auto other_corners = corners_of(other.shape);
  const bool endless =  // a plane that turns separates nothing from a half-space
      is_half_space(other.shape) ||
      (is_half_space(own.shape) && own.motion.rotation != RotationKind::fixed);
  if (!own_corners || !other_corners || endless) {
    return 0.0;
  }
  const Vector3 of_own = own.motion.pose(t - own.motion.start).orientation.conjugate() * n;
  const auto gap = [&](double d) {
    const Pose at = own.motion.pose(t - own.motion.start + d);
    const Pose other_at = other.motion.pose(t - other.motion.start + d);
    const Vector3 m = at.orientation * of_own;
    return -reach(-m, other.shape, *other_corners, other_at) -
           reach(m, own.shape, *own_corners, at);
  };
  const double before = gap(0.0);
  const Way way(own, other, t);
  if (!(before >= -way.rounding)) {
    return 0.0;
  }
  double until = 0.0;
  for (double d = way.rounding / way.speed;
       d < way.longest && way.curvature * d * d < 8.0 * way.rounding; d *= 2.0) {
    if (gap(d) > std::max(before, 0.0) + 4.0 * way.rounding) {
      until = d;
    } else if (until > 0.0) {
      break;
    }
  }
  return until;
}

}  // namespace core
}  // namespace kairos
