#include "ccd/swept_box.hpp"

#include "ccd/relative_boxes.hpp"
#include "ccd/rounding/rotation_matrix.hpp"
#include "ccd/rounding/roundoff.hpp"
#include "core/circular.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;

/// n . p(s) over [s0, s1] by Bernstein coefficients.
Reach translation_reach(const Polynomial<3>& p, double s0, double s1, const Vector3& n) {
  if (p.degree() == 0) {
    const double x = n.dot(p[0]);
    const double error = 8.0 * u * p[0].lpNorm<1>();
    return {x - error, x + error};
  }
  if (!std::isfinite(s1)) {
    return {-infinity, infinity};
  }
  std::array<Polynomial<3>::Value, Polynomial<3>::max_degree + 1> b;
  bernstein(p, s0, s1, b);
  Reach reach{infinity, -infinity};
  double size = 0.0;
  const double longest = std::abs(s0) + 2.0 * (s1 - s0);
  for (int k = p.degree(); k >= 0; --k) {
    const double x = n.dot(b[static_cast<std::size_t>(k)]);
    reach.lower = std::min(reach.lower, x);
    reach.upper = std::max(reach.upper, x);
    size = size * longest + p[k].lpNorm<1>();
  }
  const double error = (12.0 * p.degree() + 20.0) * u * size;
  return {reach.lower - error, reach.upper + error};
}

/// Greatest extent of a box along n while it turns: an axis at the angle phi from the line of n at
/// mid-time cannot come nearer to it than phi - theta, theta the angle turned in half the time.
double turning_extent(const Box& box, const Motion& motion, double s0, double s1,
                      const Vector3& n) {
  double theta = 0.0;
  double at = s0;
  if (motion.rotation != RotationKind::fixed) {
    theta = 0.5 * motion.angular_speed_bound(s0, s1) * (s1 - s0);
    at = s0 + 0.5 * (s1 - s0);
    if (!(theta < 1.6)) {
      return box.half_extents.norm() * (1.0 + 8.0 * u);
    }
  }
  const Vector3 n_B = motion.orientation(at).conjugate() * n;
  double extent = 0.0;
  for (int k = 0; k < 3; ++k) {
    double part = std::min(1.0, std::abs(n_B[k]));
    if (theta > 0.0) {
      const double phi = arc_cosine(part) - theta * (1.0 + 1e-12);
      part = phi > 0.0 ? cosine(phi) : 1.0;
    }
    extent += box.half_extents[k] * std::min(1.0, part + 32.0 * u);
  }
  return std::min(extent, box.half_extents.norm()) * (1.0 + 8.0 * u);
}

/// Bounded on one side if n is its normal but for 4 u: a normal along an axis that was computed, of
/// a body that is turned by 90 degrees, say, is off by that. At a point x such a tilt moves the
/// surface by 8 u |x|_1 at most, and by as much every reach of a body is rounded outwards. Tilted
/// by more, a half-space reaches everywhere.
Reach half_space_reach(const HalfSpace& half_space, const Motion& motion, double s0, double s1,
                       const Vector3& n) {
  const Vector3 normal = half_space_normal(half_space, motion.pose(s0));
  const double side = normal.dot(n) < 0.0 ? -1.0 : 1.0;
  if ((normal - side * n).lpNorm<Eigen::Infinity>() > 4.0 * u) {
    return {-infinity, infinity};
  }
  const Reach surface = translation_reach(motion.position, s0, s1, n);
  const double size = motion.position(s0).lpNorm<1>() + motion.position(s1).lpNorm<1>();
  const double margin = motion.error_radius + (normal == side * n ? 0.0 : 8.0 * u * size);
  return side > 0.0 ? Reach{-infinity, surface.upper + margin}
                    : Reach{surface.lower - margin, infinity};
}

Vector3 any_perpendicular(const Vector3& x) {
  int least = 0;
  x.cwiseAbs().minCoeff(&least);
  return x.cross(Vector3::Unit(least)).normalized();
}

double local(const Motion& motion, const Window& window, double t) {
  return (window.start + t) - motion.start;
}

}  // namespace

Reach swept_reach(const Shape& shape, const Motion& motion, double s0, double s1,
                  const Vector3& n) {
  if (const auto* half_space = std::get_if<HalfSpace>(&shape)) {
    return motion.rotation == RotationKind::fixed ? half_space_reach(*half_space, motion, s0, s1, n)
                                                  : Reach{-infinity, infinity};
  }
  Reach reach = translation_reach(motion.position, s0, s1, n);
  const auto* sphere = std::get_if<Sphere>(&shape);
  // A shape that is no ball reaches no farther than the box around it.
  const double extent =
      (sphere != nullptr ? sphere->radius
                         : turning_extent(bounding_box(shape), motion, s0, s1, n)) *
          (1.0 + 8.0 * u) +
      motion.error_radius;
  const double rounding =
      4.0 * u * (extent + std::max(std::abs(reach.lower), std::abs(reach.upper)));
  return {reach.lower - extent - rounding, reach.upper + extent + rounding};
}

OrientedBox swept_box(const Shape& shape, const Motion& motion, double s0, double s1,
                      const Matrix3& axes) {
  OrientedBox box;
  box.axes = axes;
  for (int k = 0; k < 3; ++k) {
    const Reach reach = swept_reach(shape, motion, s0, s1, axes.col(k));
    const double centre = 0.5 * (reach.lower + reach.upper);
    box.half_extents[k] = std::max(reach.upper - centre, centre - reach.lower) * (1.0 + 8.0 * u);
    box.centre += centre * axes.col(k);
  }
  // The centre was put together from rounded coordinates in rounded axes.
  box.half_extents.array() += 16.0 * u * (box.centre.lpNorm<1>() + box.half_extents.sum());
  return box;
}

OrientedBox swept_box(const Shape& shape, const Motion& motion, double s0, double s1) {
  const Vector3 displacement = motion.position(s1) - motion.position(s0);
  const double length = displacement.norm();
  if (!(length > 0.0)) {
    return swept_box(shape, motion, s0, s1, rotation_matrix(motion.orientation(s0)));
  }
  Matrix3 axes;
  axes.col(0) = displacement / length;
  // The second axis as near to an axis of the body as it can be.
  const Matrix3 body = rotation_matrix(motion.orientation(s0));
  int least = 0;
  (body.transpose() * axes.col(0)).cwiseAbs().minCoeff(&least);
  const Vector3 second = body.col(least) - axes.col(0) * axes.col(0).dot(body.col(least));
  axes.col(1) = second.norm() > 0.1 ? Vector3(second.normalized()) : any_perpendicular(axes.col(0));
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return swept_box(shape, motion, s0, s1, axes);
}

Aabb swept_aabb(const Shape& shape, const Motion& motion, double s0, double s1) {
  Aabb box;
  for (int k = 0; k < 3; ++k) {
    const Reach reach = swept_reach(shape, motion, s0, s1, Vector3::Unit(k));
    box.lower[k] = reach.lower;
    box.upper[k] = reach.upper;
  }
  return box;
}

bool swept_shapes_overlap(const MovingShape& a, const MovingShape& b, const Window& window) {
  const double a0 = local(a.motion, window, 0.0);
  const double a1 = local(a.motion, window, window.duration);
  const double b0 = local(b.motion, window, 0.0);
  const double b1 = local(b.motion, window, window.duration);
  if (const auto* half_space = std::get_if<HalfSpace>(&b.shape)) {
    if (std::holds_alternative<HalfSpace>(a.shape)) {
      return false;
    }
    if (b.motion.rotation != RotationKind::fixed) {
      return true;
    }
    const Vector3 n = half_space_normal(*half_space, b.motion.pose(b0));
    return swept_reach(a.shape, a.motion, a0, a1, n).lower <=
           translation_reach(b.motion.position, b0, b1, n).upper + b.motion.error_radius;
  }
  if (!std::isfinite(window.duration)) {
    return swept_aabb(a.shape, a.motion, a0, a1).overlaps(swept_aabb(b.shape, b.motion, b0, b1));
  }
  const OrientedBox box_a = swept_box(a.shape, a.motion, a0, a1);
  const OrientedBox box_b = swept_box(b.shape, b.motion, b0, b1);
  const RelativeBoxes boxes(box_a.half_extents, box_a.axes, box_b.half_extents, box_b.axes,
                            box_b.centre - box_a.centre);
  return classify(boxes) != Verdict::separated;
}

}  // namespace kairos::ccd
