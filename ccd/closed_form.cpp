#include "ccd/closed_form.hpp"

#include "ccd/pair_overlap.hpp"
#include "ccd/parabola.hpp"
#include "ccd/quadratic_gap.hpp"
#include "ccd/rotation_matrix.hpp"
#include "ccd/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;

/// Local time of a motion at window time t, as everybody else computes it.
double local_time(const Motion& motion, const Window& window, double t) {
  return (window.start + t) - motion.start;
}

double start_of(const Motion& motion, const Window& window) {
  return window.start == motion.start ? 0.0 : window.start - motion.start;
}

/// Roundoff of the coordinates at the start: gaps within it of zero are contacts.
double touch_band(const Motion& a, const Motion& b, double size) {
  return 64.0 * u *
         (a.position[0].lpNorm<Eigen::Infinity>() + b.position[0].lpNorm<Eigen::Infinity>() + size);
}

// ---- sphere and half-space ----------------------------------------------------------------------

bool is_identity(const Quaternion& q) { return q.x() == 0.0 && q.y() == 0.0 && q.z() == 0.0; }

/// Gap of a sphere, of reach `reach` (radius and error radii), above a plane that does not turn.
QuadraticGap gap_above_plane(const Parabola& d, const Quaternion& orientation, const Vector3& n,
                             double reach) {
  if (is_identity(orientation)) {  // the normal is exactly +y: the projections are not rounded
    const double c0 = d.c0.y() - reach;
    return {c0, d.c1.y(), d.c2.y(), d.e0 + u * std::abs(c0), d.e1, d.e2};
  }
  // Normal off by at most 8 u, dot product by 3 u of the sum of its terms' sizes.
  const double k = 12.0 * u;
  const double c0 = n.dot(d.c0) - reach;
  return {c0,
          n.dot(d.c1),
          n.dot(d.c2),
          2.0 * d.e0 + k * d.c0.lpNorm<1>() + u * std::abs(c0),
          2.0 * d.e1 + k * d.c1.lpNorm<1>(),
          2.0 * d.e2 + k * d.c2.lpNorm<1>()};
}

struct SphereAndPlane {
  const Sphere& sphere;
  const Motion& motion;
  const Motion& plane;
};

// ---- two spheres --------------------------------------------------------------------------------

/// Distance of two points in uniform relative motion, less `reach`.
struct DistanceGap {
  Vector3 d, v;
  double reach;
  double e0, e1;

  double operator()(double t) const { return (d + v * t).norm() - reach; }
  double rate(double t) const {
    const Vector3 at = d + v * t;
    return at.dot(v) / at.norm();
  }
  double error(double t) const {
    return 2.0 * (e0 + e1 * t) +
           6.0 * u * (d.lpNorm<Eigen::Infinity>() + v.lpNorm<Eigen::Infinity>() * t + reach);
  }
};

FirstDescent first_descent(const DistanceGap& gap, double touch) {
  const double start = gap(0.0);
  const double approach = gap.d.dot(gap.v);
  const double speed_squared = gap.v.squaredNorm();
  if (start < -touch) {
    return {Descent::inside, 0.0, 0.0};
  }
  if (start <= gap.error(0.0)) {
    if (approach < 0.0) {
      return {Descent::in_touch, 0.0, 0.0};
    }
    return {speed_squared > 0.0 ? Descent::none : Descent::sliding, 0.0, infinity};
  }
  if (!(approach < 0.0)) {
    return {Descent::none, 0.0, 0.0};
  }
  // Nearest approach |d x v| / |v| against the reach decides; Lagrange's identity turns the
  // discriminant into (reach - miss)(reach + miss) |v|^2, which does not cancel.
  const double speed = std::sqrt(speed_squared);
  const double nearest_at = -approach / speed_squared;
  const double miss = gap.d.cross(gap.v).norm() / speed;
  const double error = gap.error(nearest_at) + 8.0 * u * gap.d.lpNorm<1>();
  if (miss > gap.reach + error) {
    return {Descent::none, 0.0, 0.0};
  }
  if (miss >= gap.reach - error) {
    // The gap is below 3 error within sqrt(8 error reach) / speed of the nearest approach.
    const double half_width = std::sqrt(8.0 * error * gap.reach) / speed + 2.0 * ulp(nearest_at);
    return {Descent::grazing, std::max(0.0, nearest_at - half_width), nearest_at + half_width};
  }
  const double inwards = std::sqrt((gap.reach - miss) * (gap.reach + miss));
  double root = start * (start + 2.0 * gap.reach) / (-approach + speed * inwards);
  root -= gap(root) / gap.rate(root);  // the distance itself is better conditioned than its square
  FirstDescent found{Descent::found, root, root};
  double margin = gap.error(root) / std::abs(gap.rate(root)) + 2.0 * ulp(root);
  do {
    found.t_lo = std::max(0.0, root - margin);
    margin *= 2.0;
  } while (found.t_lo > 0.0 && gap(found.t_lo) <= gap.error(found.t_lo));
  margin = gap.error(root) / std::abs(gap.rate(root)) + 2.0 * ulp(root);
  do {
    found.t_hi = std::min(nearest_at, root + margin);
    margin *= 2.0;
  } while (found.t_hi < nearest_at && gap(found.t_hi) >= -gap.error(found.t_hi));
  return found;
}

// ---- answers ------------------------------------------------------------------------------------

TimeOfImpact answer(const FirstDescent& descent, double duration, int evaluations) {
  TimeOfImpact toi;
  toi.evaluations = evaluations;
  toi.t_lo = toi.t_hi = duration;
  if (descent.kind == Descent::none || descent.t_lo > duration) {
    return toi;
  }
  toi.t_lo = descent.t_lo;
  toi.t_hi = std::min(descent.t_hi, duration);
  switch (descent.kind) {
    case Descent::inside:
      toi.status = ToiStatus::overlapping;
      break;
    case Descent::found:
      toi.status = descent.t_hi <= duration ? ToiStatus::impact : ToiStatus::undecided;
      break;
    case Descent::in_touch:
      toi.status = ToiStatus::impact;
      break;
    default:
      toi.status = ToiStatus::undecided;
  }
  return toi;
}

/// The pair in order (sphere, plane), if it is one of that kind.
std::optional<SphereAndPlane> sphere_and_plane(const MovingShape& a, const MovingShape& b) {
  const auto* sphere = std::get_if<Sphere>(&a.shape);
  if (sphere == nullptr || !std::holds_alternative<HalfSpace>(b.shape) ||
      b.motion.rotation != RotationKind::fixed || !is_parabola(a.motion) ||
      !is_parabola(b.motion)) {
    return std::nullopt;
  }
  return SphereAndPlane{*sphere, a.motion, b.motion};
}

Vector3 plane_normal(const Motion& plane) {
  return rotation_matrix(plane.orientation(0.0)).col(1);
}

QuadraticGap gap_of(const SphereAndPlane& pair, const Window& window, const Vector3& n) {
  const Parabola d = relative_parabola(pair.plane, start_of(pair.plane, window), pair.motion,
                                       start_of(pair.motion, window));
  return gap_above_plane(d, pair.plane.orientation(0.0), n,
                         pair.sphere.radius + (pair.motion.error_radius + pair.plane.error_radius));
}

/// Gap, normal (from the sphere into the plane) and witnesses at `t_lo`, after stepping back until
/// the float gap is positive too.
void complete(const SphereAndPlane& pair, const QuadraticGap& gap, const Window& window,
              const Vector3& n, TimeOfImpact& toi) {
  Vector3 centre, origin;
  double height = 0.0;
  double back = ulp(toi.t_lo);
  for (int attempt = 0; attempt < 12; ++attempt) {
    centre = pair.motion.position(local_time(pair.motion, window, toi.t_lo));
    origin = pair.plane.position(local_time(pair.plane, window, toi.t_lo));
    height = n.dot(centre - origin);
    if (height > pair.sphere.radius || toi.t_lo == 0.0 || toi.status == ToiStatus::overlapping) {
      break;
    }
    toi.t_lo = std::max(0.0, toi.t_lo - back);
    back *= 2.0;
  }
  toi.gap = std::max(0.0, gap(toi.t_lo) - gap.error(toi.t_lo));
  toi.normal = -n;
  toi.witness_a = centre - n * pair.sphere.radius;
  toi.witness_b = centre - n * height;
}

TimeOfImpact swapped(TimeOfImpact toi) {
  toi.normal = -toi.normal;
  std::swap(toi.witness_a, toi.witness_b);
  return toi;
}

std::optional<TimeOfImpact> sphere_plane_impact(const MovingShape& a, const MovingShape& b,
                                                const Window& window) {
  const auto pair = sphere_and_plane(a, b);
  if (!pair) {
    return std::nullopt;
  }
  const Vector3 n = plane_normal(pair->plane);
  const QuadraticGap gap = gap_of(*pair, window, n);
  const double touch = touch_band(pair->motion, pair->plane, pair->sphere.radius);
  TimeOfImpact toi = answer(first_descent(gap, touch), window.duration, 1);
  if (toi.status != ToiStatus::separated) {
    complete(*pair, gap, window, n, toi);
  }
  return toi;
}

/// Two spheres whose relative motion is uniform.
std::optional<DistanceGap> distance_gap(const MovingShape& a, const MovingShape& b,
                                        const Window& window) {
  const auto* sphere_a = std::get_if<Sphere>(&a.shape);
  const auto* sphere_b = std::get_if<Sphere>(&b.shape);
  if (sphere_a == nullptr || sphere_b == nullptr || !is_parabola(a.motion) ||
      !is_parabola(b.motion)) {
    return std::nullopt;
  }
  const Parabola d =
      relative_parabola(a.motion, start_of(a.motion, window), b.motion, start_of(b.motion, window));
  if (!d.c2.isZero(0.0)) {
    return std::nullopt;
  }
  const double reach =
      (sphere_a->radius + sphere_b->radius) + (a.motion.error_radius + b.motion.error_radius);
  return DistanceGap{d.c0, d.c1, reach, d.e0, d.e1};
}

void complete(const DistanceGap& gap, const MovingShape& a, const MovingShape& b,
              const Window& window, TimeOfImpact& toi) {
  retreat_from_overlap(a, b, window, toi);
  const double radius_a = std::get<Sphere>(a.shape).radius;
  const Vector3 at = gap.d + gap.v * toi.t_lo;
  const double distance = at.norm();
  toi.gap = std::max(0.0, distance - gap.reach - gap.error(toi.t_lo));
  toi.normal = distance > 0.0 ? Vector3(at / distance) : Vector3(Vector3::UnitY());
  const Vector3 centre_a = a.motion.position(local_time(a.motion, window, toi.t_lo));
  toi.witness_a = centre_a + toi.normal * radius_a;
  toi.witness_b = centre_a + toi.normal * (distance - std::get<Sphere>(b.shape).radius);
}

/// Parting of a pair whose gap is `gap`: the first ascent of the gap is a descent of its opposite.
TimeOfImpact parting(double start, double error, const FirstDescent& ascent, double duration) {
  if (start > error) {
    return {};
  }
  TimeOfImpact toi = answer(ascent, duration, 1);
  switch (ascent.kind) {
    case Descent::none:
    case Descent::sliding:
      toi.status = ToiStatus::overlapping;
      break;
    case Descent::in_touch:  // in touch and leaving
    case Descent::inside:
      toi.status = ToiStatus::impact;
      toi.t_lo = toi.t_hi = 0.0;
      break;
    default:
      if (toi.status == ToiStatus::separated) {
        toi.status = ToiStatus::overlapping;  // parts after the window
      }
  }
  return toi;
}

}  // namespace

void retreat_from_overlap(const MovingShape& a, const MovingShape& b, const Window& window,
                          TimeOfImpact& toi) {
  if (toi.status == ToiStatus::overlapping) {
    return;
  }
  double back = ulp(toi.t_lo);
  for (int attempt = 0; attempt < 24 && toi.t_lo > 0.0; ++attempt) {
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
  if (auto toi = sphere_plane_impact(a, b, window)) {
    return toi;
  }
  if (auto toi = sphere_plane_impact(b, a, window)) {
    return swapped(*toi);
  }
  const auto gap = distance_gap(a, b, window);
  if (!gap) {
    return std::nullopt;
  }
  const double touch = touch_band(a.motion, b.motion, gap->reach);
  TimeOfImpact toi = answer(first_descent(*gap, touch), window.duration, 1);
  if (toi.status != ToiStatus::separated) {
    complete(*gap, a, b, window, toi);
  }
  return toi;
}

std::optional<TimeOfImpact> closed_form_separation(const MovingShape& a, const MovingShape& b,
                                                   const Window& window) {
  for (const bool swap : {false, true}) {
    const auto pair = swap ? sphere_and_plane(b, a) : sphere_and_plane(a, b);
    if (!pair) {
      continue;
    }
    const Vector3 n = plane_normal(pair->plane);
    const QuadraticGap gap = gap_of(*pair, window, n);
    const QuadraticGap depth{-gap.c0, -gap.c1, -gap.c2, gap.e0, gap.e1, gap.e2};
    const double touch = touch_band(pair->motion, pair->plane, pair->sphere.radius);
    TimeOfImpact toi = parting(gap.c0, touch, first_descent(depth, touch), window.duration);
    toi.normal = swap ? n : Vector3(-n);
    return toi;
  }
  const auto gap = distance_gap(a, b, window);
  if (!gap) {
    return std::nullopt;
  }
  const double touch = touch_band(a.motion, b.motion, gap->reach);
  const double start = (*gap)(0.0);
  TimeOfImpact toi;
  if (start > touch) {
    return toi;
  }
  const double speed_squared = gap->v.squaredNorm();
  toi.status = ToiStatus::overlapping;
  toi.t_lo = toi.t_hi = window.duration;
  if (speed_squared > 0.0) {
    const double speed = std::sqrt(speed_squared);
    const double miss = gap->d.cross(gap->v).norm() / speed;
    const double inwards = std::sqrt(std::max(0.0, (gap->reach - miss) * (gap->reach + miss)));
    const double root = std::max(0.0, (-gap->d.dot(gap->v) / speed + inwards) / speed);
    double margin = 2.0 * ulp(root) + gap->error(root) / std::max(inwards / gap->reach * speed,
                                                                  unit_roundoff * speed);
    double t_hi = root + margin;
    while (std::isfinite(margin) && (*gap)(t_hi) <= gap->error(t_hi)) {
      margin *= 2.0;
      t_hi = root + margin;
    }
    if (t_hi <= window.duration) {
      toi.status = ToiStatus::impact;
      toi.t_lo = std::max(0.0, root - margin);
      toi.t_hi = t_hi;
    }
  }
  const Vector3 at = gap->d + gap->v * (std::isfinite(toi.t_lo) ? toi.t_lo : 0.0);
  toi.normal = at.norm() > 0.0 ? Vector3(at.normalized()) : Vector3(Vector3::UnitY());
  return toi;
}

}  // namespace kairos::ccd
