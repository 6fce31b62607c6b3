#include "ccd/sphere_plane.hpp"

#include "ccd/closed_form.hpp"
#include "ccd/descent_answer.hpp"
#include "ccd/plane_normal.hpp"
#include "ccd/query_check.hpp"
#include "ccd/sphere_sphere.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;

/// n . p of a parabola from local time s on, with bounds of the errors.
struct Projection {
  double c0 = 0.0, c1 = 0.0, c2 = 0.0;
  double e0 = 0.0, e1 = 0.0, e2 = 0.0;
};

/// Along an axis exactly (only a difference is rounded), or along any n, known in twice the
/// precision.
struct AlongAxis {
  int axis;
  double sign;
  double operator()(const Vector3& x) const { return sign * x[axis]; }
  double error(double /*h*/, const Vector3& /*x*/) const { return 0.0; }
  double difference(const Vector3& x, const Vector3& y) const { return sign * (x[axis] - y[axis]); }
  double difference_error(double h, const Vector3& /*x*/, const Vector3& y) const {
    return y[axis] == 0.0 ? 0.0 : u * std::abs(h);
  }
};
struct Along {
  const PlaneNormal& n;
  double operator()(const Vector3& x) const { return n.height(x); }
  double error(double h, const Vector3& x) const { return PlaneNormal::error(h, x.lpNorm<1>()); }
  double difference(const Vector3& x, const Vector3& y) const { return n.height(x, y); }
  double difference_error(double h, const Vector3& x, const Vector3& y) const {
    return PlaneNormal::error(h, x.lpNorm<1>() + y.lpNorm<1>());
  }
};

template <typename Direction>
Projection project(const Polynomial<3>& p, const Direction& along) {
  Projection q{along(p[0])};
  q.e0 = along.error(q.c0, p[0]);
  if (p.degree() > 0) {
    q.c1 = along(p[1]);
    q.e1 = along.error(q.c1, p[1]);
  }
  if (p.degree() > 1) {
    q.c2 = along(p[2]);
    q.e2 = along.error(q.c2, p[2]);
  }
  return q;
}

void shift(Projection& q, double s) {
  if (s == 0.0 || (q.c1 == 0.0 && q.c2 == 0.0 && q.e1 == 0.0 && q.e2 == 0.0)) {
    return;
  }
  const double size = std::abs(s);
  q.e0 += (q.e1 + q.e2 * size) * size +
          5.0 * u * (std::abs(q.c0) + (std::abs(q.c1) + std::abs(q.c2) * size) * size);
  q.e1 += 2.0 * q.e2 * size + 3.0 * u * (std::abs(q.c1) + 2.0 * std::abs(q.c2) * size);
  q.c0 += (q.c1 + q.c2 * s) * s;
  q.c1 += 2.0 * q.c2 * s;
}

/// x - y, and what it may be off by: nothing where y is zero.
double difference(double x, double y, double& error) {
  const double d = x - y;
  error += y == 0.0 ? 0.0 : u * std::abs(d);
  return d;
}

/// Height of the sphere above the plane less its reach (radius and error radii). Coefficients are
/// subtracted before they are projected: far from the origin that loses nothing.
template <typename Direction>
QuadraticGap gap_along(const Motion& sphere, double s, const Motion& plane, double s_p,
                       double reach, const Direction& along) {
  QuadraticGap gap;
  if (plane.position.degree() == 0) {
    Projection a = project(sphere.position, along);
    a.c0 = along.difference(sphere.position[0], plane.position[0]);
    a.e0 = along.difference_error(a.c0, sphere.position[0], plane.position[0]);
    shift(a, s);
    gap = {a.c0, a.c1, a.c2, a.e0, a.e1, a.e2};
  } else if (s == 0.0 && s_p == 0.0) {
    double c[3] = {0.0, 0.0, 0.0};
    double e[3] = {0.0, 0.0, 0.0};
    const auto coefficient = [](const Polynomial<3>& p, int k) {
      return k <= p.degree() ? Vector3(p[k]) : Vector3(Vector3::Zero());
    };
    for (int k = 0; k <= std::max(sphere.position.degree(), plane.position.degree()); ++k) {
      const Vector3 x = coefficient(sphere.position, k);
      const Vector3 y = coefficient(plane.position, k);
      c[k] = along.difference(x, y);
      e[k] = along.difference_error(c[k], x, y);
    }
    gap = {c[0], c[1], c[2], e[0], e[1], e[2]};
  } else {
    Projection a = project(sphere.position, along);
    Projection b = project(plane.position, along);
    shift(a, s);
    shift(b, s_p);
    gap = {0.0, 0.0, 0.0, a.e0 + b.e0, a.e1 + b.e1, a.e2 + b.e2};
    gap.c0 = difference(a.c0, b.c0, gap.e0);
    gap.c1 = difference(a.c1, b.c1, gap.e1);
    gap.c2 = difference(a.c2, b.c2, gap.e2);
  }
  gap.c0 = difference(gap.c0, reach, gap.e0);
  return gap;
}

/// A sphere and a plane in motion, and the gap between them.
struct SphereAbovePlane {
  const Motion& sphere;
  const HalfSpace& half_space;
  const Motion& plane;
  const Window& window;
  double radius;
  bool along_axis;  ///< the normal is an axis of the world, exactly
  Vector3 n;
  QuadraticGap gap;

  SphereAbovePlane(const Sphere& shape, const Motion& motion, const HalfSpace& half_space_,
                   const Motion& plane_, const Window& window_)
      : sphere(motion),
        half_space(half_space_),
        plane(plane_),
        window(window_),
        radius(shape.radius) {
    const Vector4& q = plane.quaternion[0];
    const double s = start_of(sphere, window);
    const double s_p = start_of(plane, window);
    const double reach = radius + (sphere.error_radius + plane.error_radius);
    const PlaneNormal normal(half_space.normal_B, q);
    n = normal.rounded();
    int axis = 0;
    along_axis = normal.is_axis(axis);
    if (along_axis) {
      gap = gap_along(sphere, s, plane, s_p, reach, AlongAxis{axis, n[axis]});
    } else {
      gap = gap_along(sphere, s, plane, s_p, reach, Along{normal});
    }
  }

  [[nodiscard]] double touch() const { return touch_band(sphere, plane, radius); }

  /// Normal and witnesses at `t_lo`, after stepping back, by ulps, until the height of the sphere
  /// as anyone computes it from the motions is positive as well.
  void complete(TimeOfImpact& toi) const {
    Vector3 centre;
    double height = 0.0;
    const Vector3 up = half_space_normal(half_space, {plane.position[0], plane.orientation(0.0)});
    const double first = toi.t_lo;
    double back = ulp(toi.t_lo);
    for (int attempt = 0; attempt < most_retreats; ++attempt) {
      centre = sphere.position(local_time(sphere, window, toi.t_lo));
      const Vector3 origin = plane.position.degree() == 0
                                 ? plane.position[0]
                                 : plane.position(local_time(plane, window, toi.t_lo));
      height = up.dot(centre - origin);
      // Along an axis every caller computes this height; along any other with some roundings, and
      // along a normal of another length if the quaternion is not of length one to roundoff.
      const double rounding = along_axis ? 0.0 : 8.0 * u * ((centre - origin).lpNorm<1>() + radius);
      const double least = along_axis ? height : std::min(height, n.dot(centre - origin));
      const double reach = radius + (sphere.error_radius + plane.error_radius);
      if (least - reach > rounding || toi.t_lo == 0.0 || toi.status == ToiStatus::overlapping) {
        break;
      }
      toi.t_lo = std::max(0.0, first - back);
      back *= 2.0;
    }
    toi.gap = std::max(0.0, gap(toi.t_lo) - gap.error(toi.t_lo));
    toi.normal = -n;
    toi.witness_a = centre - n * radius;
    toi.witness_b = centre - n * height;
  }
};

TimeOfImpact impact_of(const SphereAbovePlane& pair) {
  TimeOfImpact toi = descent_answer(first_descent(pair.gap, pair.touch()), pair.window.duration);
  if (toi.status != ToiStatus::separated) {
    pair.complete(toi);
  }
  return toi;
}

const Sphere* sphere_of(const MovingShape& a, const MovingShape& b) {
  const auto* sphere = std::get_if<Sphere>(&a.shape);
  return sphere != nullptr && std::holds_alternative<HalfSpace>(b.shape) &&
                 b.motion.rotation == RotationKind::fixed && a.motion.position.degree() <= 2 &&
                 b.motion.position.degree() <= 2
             ? sphere
             : nullptr;
}

}  // namespace

std::optional<TimeOfImpact> sphere_plane_impact(const MovingShape& a, const MovingShape& b,
                                                const Window& window) {
  const Sphere* sphere = sphere_of(a, b);
  if (sphere == nullptr) {
    return std::nullopt;
  }
  return impact_of({*sphere, a.motion, std::get<HalfSpace>(b.shape), b.motion, window});
}

std::optional<TimeOfImpact> sphere_plane_impact(const BallFlight& ball, const HalfSpace& half_space,
                                                const Pose& at_rest, const Window& window) {
  if (!(window.duration >= 0.0) || !is_ordinary(ball, window) ||
      !(at_rest.position.lpNorm<1>() <= greatest_size)) {
    return std::nullopt;
  }
  Motion flight;
  flight.start = ball.start;
  flight.position = Polynomial<3>(ball.position, ball.velocity, 0.5 * ball.acceleration);
  Motion plane;
  plane.start = window.start;
  plane.position[0] = at_rest.position;
  const Quaternion& q = at_rest.orientation;
  plane.quaternion[0] = Vector4(q.w(), q.x(), q.y(), q.z());
  return impact_of({Sphere{ball.radius}, flight, half_space, plane, window});
}

std::optional<TimeOfImpact> sphere_plane_separation(const MovingShape& a, const MovingShape& b,
                                                    const Window& window) {
  const Sphere* sphere = sphere_of(a, b);
  if (sphere == nullptr) {
    return std::nullopt;
  }
  const SphereAbovePlane pair(*sphere, a.motion, std::get<HalfSpace>(b.shape), b.motion, window);
  TimeOfImpact toi;
  toi.normal = -pair.n;
  if (pair.gap.c0 > pair.touch()) {
    return toi;
  }
  // The first ascent of the gap is the first descent of the depth.
  const QuadraticGap depth{-pair.gap.c0, -pair.gap.c1, -pair.gap.c2,
                           pair.gap.e0,  pair.gap.e1,  pair.gap.e2};
  const FirstDescent ascent = first_descent(depth, pair.touch());
  toi = descent_answer(ascent, window.duration);
  toi.normal = -pair.n;
  if (ascent.kind == Descent::in_touch || ascent.kind == Descent::inside) {
    toi.status = ToiStatus::impact;
    toi.t_lo = toi.t_hi = 0.0;  // in touch, and leaving
  } else if (ascent.kind == Descent::none || ascent.kind == Descent::sliding ||
             toi.status == ToiStatus::separated) {
    toi.status = ToiStatus::overlapping;
    toi.t_lo = toi.t_hi = window.duration;
  }
  return toi;
}

}  // namespace kairos::ccd
