#include "ccd/sphere_sphere.hpp"

#include "ccd/closed_form.hpp"
#include "ccd/descent_answer.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;

double largest(const Vector3& x) { return x.cwiseAbs().maxCoeff(); }

/// Position and velocity of a parabola at local time s, and what they may be off by.
struct Seen {
  Vector3 p, v;
  double e_p = 0.0, e_v = 0.0;
};

Seen seen(const Polynomial<3>& p, double s) {
  if (p.degree() == 0) {
    return {p[0], Vector3::Zero()};
  }
  if (s == 0.0) {
    return {p[0], p[1]};
  }
  const Vector3 c = p.degree() > 1 ? Vector3(p[2]) : Vector3(Vector3::Zero());
  Seen at{p[0] + (p[1] + c * s) * s, p[1] + 2.0 * c * s};
  at.e_p = 5.0 * u * (largest(p[0]) + (largest(p[1]) + largest(c) * std::abs(s)) * std::abs(s));
  at.e_v = 3.0 * u * (largest(p[1]) + 2.0 * largest(c) * std::abs(s));
  return at;
}

bool same_acceleration(const Polynomial<3>& a, const Polynomial<3>& b) {
  if (a.degree() > 2 || b.degree() > 2) {
    return false;
  }
  if (a.degree() < 2 && b.degree() < 2) {
    return true;
  }
  return a.degree() == b.degree() && a[2] == b[2];
}

/// Distance of two points in uniform relative motion, less `reach` (radii and error radii).
struct DistanceGap {
  Vector3 d, v;
  double reach = 0.0;
  double e0 = 0.0, e1 = 0.0;  ///< |error| <= e0 + e1 t

  DistanceGap(const MovingShape& a, const MovingShape& b, const Window& window) {
    const Seen at_a = seen(a.motion.position, start_of(a.motion, window));
    const Seen at_b = seen(b.motion.position, start_of(b.motion, window));
    d = at_b.p - at_a.p;
    v = at_b.v - at_a.v;
    reach = (std::get<Sphere>(a.shape).radius + std::get<Sphere>(b.shape).radius) +
            (a.motion.error_radius + b.motion.error_radius);
    e0 = 2.0 * (at_a.e_p + at_b.e_p) + 8.0 * u * (largest(d) + reach);
    e1 = 2.0 * (at_a.e_v + at_b.e_v) + 8.0 * u * largest(v);
  }

  double operator()(double t) const { return (d + v * t).norm() - reach; }
  double rate(double t) const {
    const Vector3 at = d + v * t;
    return at.dot(v) / at.norm();
  }
  double error(double t) const { return e0 + e1 * t; }
};

/// Bracket of the crossing of zero near `root`: outwards by two ulp and the error over the rate,
/// further while the signs are not proven. `limit` is the time of nearest approach.
FirstDescent bracket(const DistanceGap& gap, double root, double limit) {
  const double step = gap.error(root) / std::abs(gap.rate(root)) + 2.0 * ulp(root);
  FirstDescent found{Descent::found, root, root};
  double margin = step;
  do {
    found.t_lo = std::max(0.0, root - margin);
    margin *= 2.0;
  } while (found.t_lo > 0.0 && gap(found.t_lo) <= gap.error(found.t_lo));
  if (found.t_lo == 0.0) {
    found.t_lo = last_proven(gap, 0.0, root);
  }
  margin = step;
  do {
    found.t_hi = std::min(limit, root + margin);
    margin *= 2.0;
  } while (found.t_hi < limit && gap(found.t_hi) >= -gap.error(found.t_hi));
  return found;
}

/// The relative velocity is zero but for roundoff, which is at most `speed`.
FirstDescent at_relative_rest(const DistanceGap& gap, double start, bool in_touch, double speed) {
  if (in_touch) {
    return {Descent::sliding, 0.0, infinity};
  }
  return speed > 0.0 ? FirstDescent{Descent::grazing, (start - gap.e0) / speed, infinity}
                     : FirstDescent{};
}

FirstDescent first_descent(const DistanceGap& gap, double touch) {
  const double approach = gap.d.dot(gap.v);
  const double distance = gap.d.norm();
  const double start = distance - gap.reach;
  if (start < -touch) {
    return {Descent::inside, 0.0, 0.0};
  }
  const bool in_touch = start <= gap.error(0.0);
  const double speed = gap.v.norm();
  // Nearest, errors that grow with time included: where the distance grows as they do (eq. 15).
  const double nearest_at = std::max(0.0, (gap.e1 * distance - approach) / (speed * speed));
  if (!std::isfinite(nearest_at)) {
    return at_relative_rest(gap, start, in_touch, gap.e1 + speed);
  }
  const double miss = approach < 0.0 ? gap.d.cross(gap.v).norm() / speed : distance;
  const double error = gap.error(nearest_at) + 8.0 * u * distance;
  if (in_touch) {
    // Tangential: it leaves, and is never deeper than rounding, whatever the sign of the approach.
    const bool leaves = !(approach < 0.0) || miss - gap.reach >= -(touch + error);
    return {leaves ? Descent::none : Descent::in_touch, 0.0, 0.0};
  }
  if (miss > gap.reach + error || (!(approach < 0.0) && gap(nearest_at) > gap.error(nearest_at))) {
    return {Descent::none, 0.0, 0.0};
  }
  if (miss >= gap.reach - error || !(approach < 0.0)) {
    const double t_lo = last_proven(gap, 0.0, nearest_at);
    return {Descent::grazing, t_lo, 2.0 * nearest_at - t_lo};
  }
  // Lagrange's identity (eq. 14) turns the discriminant into (reach - miss)(reach + miss) |v|^2,
  // which does not cancel.
  const double inwards = std::sqrt((gap.reach - miss) * (gap.reach + miss));
  double root = start * (start + 2.0 * gap.reach) / (-approach + speed * inwards);
  root -= gap(root) / gap.rate(root);  // the distance itself is better conditioned than its square
  return bracket(gap, root, nearest_at);
}

/// When two overlapping spheres part: the second root.
TimeOfImpact parting(const DistanceGap& gap, const Window& window) {
  TimeOfImpact toi;
  toi.status = ToiStatus::overlapping;
  toi.evaluations = 1;
  toi.t_lo = toi.t_hi = window.duration;
  const double speed = gap.v.norm();
  if (!(speed > 0.0)) {
    return toi;
  }
  const double miss = gap.d.cross(gap.v).norm() / speed;
  const double inwards = std::sqrt(std::max(0.0, (gap.reach - miss) * (gap.reach + miss)));
  const double root = std::max(0.0, (-gap.d.dot(gap.v) / speed + inwards) / speed);
  const double rate = std::max(inwards / gap.reach, u) * speed;
  double margin = 2.0 * ulp(root) + gap.error(root) / rate;
  while (std::isfinite(margin) && gap(root + margin) <= gap.error(root + margin)) {
    margin *= 2.0;
  }
  if (root + margin <= window.duration) {
    toi.status = ToiStatus::impact;
    toi.t_lo = std::max(0.0, root - margin);
    toi.t_hi = root + margin;
  }
  return toi;
}

bool uniform(const MovingShape& a, const MovingShape& b) {
  return std::holds_alternative<Sphere>(a.shape) && std::holds_alternative<Sphere>(b.shape) &&
         same_acceleration(a.motion.position, b.motion.position);
}

Vector3 direction(const Vector3& d) {
  const double length = d.norm();
  return length > 0.0 ? Vector3(d / length) : Vector3(Vector3::UnitY());
}

}  // namespace

std::optional<TimeOfImpact> sphere_sphere_impact(const MovingShape& a, const MovingShape& b,
                                                 const Window& window) {
  if (!uniform(a, b)) {
    return std::nullopt;
  }
  const DistanceGap gap(a, b, window);
  const double touch = touch_band(a.motion, b.motion, gap.reach);
  std::optional<TimeOfImpact> toi = descent_answer(first_descent(gap, touch), window.duration);
  if (toi->status == ToiStatus::separated) {
    return toi;
  }
  retreat_from_overlap(a, b, window, *toi);
  const Vector3 at = gap.d + gap.v * toi->t_lo;
  const Vector3 centre_a = a.motion.position(local_time(a.motion, window, toi->t_lo));
  toi->gap = std::max(0.0, at.norm() - gap.reach - gap.error(toi->t_lo));
  toi->normal = direction(at);
  toi->witness_a = centre_a + toi->normal * std::get<Sphere>(a.shape).radius;
  toi->witness_b = centre_a + toi->normal * (at.norm() - std::get<Sphere>(b.shape).radius);
  return toi;
}

std::optional<TimeOfImpact> sphere_sphere_separation(const MovingShape& a, const MovingShape& b,
                                                     const Window& window) {
  if (!uniform(a, b)) {
    return std::nullopt;
  }
  const DistanceGap gap(a, b, window);
  if (gap(0.0) > touch_band(a.motion, b.motion, gap.reach)) {
    return TimeOfImpact{};
  }
  TimeOfImpact toi = parting(gap, window);
  toi.normal = direction(gap.d + gap.v * (std::isfinite(toi.t_lo) ? toi.t_lo : 0.0));
  return toi;
}

}  // namespace kairos::ccd
