#include "ccd/sphere_sphere.hpp"

#include "ccd/closed_form.hpp"
#include "ccd/descent_answer.hpp"
#include "ccd/query_check.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;

double largest(const Vector3& x) { return x.cwiseAbs().maxCoeff(); }

/// A ball on a parabola, as far as it matters here.
struct Ball {
  int degree;  ///< of the parabola
  Vector3 p, v, c;
  Instant start;
  double radius;
  double error;

  explicit Ball(const MovingShape& of)
      : degree(of.motion.position.degree()),
        p(of.motion.position[0]),
        v(degree > 0 ? Vector3(of.motion.position[1]) : Vector3(Vector3::Zero())),
        c(degree > 1 ? Vector3(of.motion.position[2]) : Vector3(Vector3::Zero())),
        start(of.motion.start),
        radius(std::get<Sphere>(of.shape).radius),
        error(of.motion.error_radius) {}
  explicit Ball(const BallFlight& of)
      : degree(2),
        p(of.position),
        v(of.velocity),
        c(0.5 * of.acceleration),
        start(of.start),
        radius(of.radius),
        error(0.0) {}

  /// As the `Polynomial` has it.
  [[nodiscard]] Vector3 at(double s) const {
    return degree == 2 ? Vector3((c * s + v) * s + p) : degree == 1 ? Vector3(v * s + p) : p;
  }
};

/// Local time of the ball's motion at the start of a window.
double start_of(const Ball& ball, const Window& window) {
  return window.start == ball.start ? 0.0 : window.start - ball.start;
}

/// Position and velocity of a parabola at local time s, and what they may be off by.
struct Seen {
  Vector3 p, v;
  double e_p = 0.0, e_v = 0.0;
};

Seen seen(const Ball& of, double s) {
  if (of.degree == 0 || s == 0.0) {
    return {of.p, of.v};
  }
  Seen at{of.p + (of.v + of.c * s) * s, of.v + 2.0 * of.c * s};
  at.e_p = 5.0 * u * (largest(of.p) + (largest(of.v) + largest(of.c) * std::abs(s)) * std::abs(s));
  at.e_v = 3.0 * u * (largest(of.v) + 2.0 * largest(of.c) * std::abs(s));
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

  DistanceGap(const Ball& a, const Ball& b, const Window& window) {
    const Seen at_a = seen(a, start_of(a, window));
    const Seen at_b = seen(b, start_of(b, window));
    d = at_b.p - at_a.p;
    v = at_b.v - at_a.v;
    reach = (a.radius + b.radius) + (a.error + b.error);
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

/// See `touch_band`.
double touch_of(const Ball& a, const Ball& b, double size) {
  return 64.0 * u * (largest(a.p) + largest(b.p) + size);
}

FirstDescent descent_of(const DistanceGap& gap, const Ball& a, const Ball& b) {
  return first_descent(gap, touch_of(a, b, gap.reach));
}

/// Whether both are ordinary, and accelerated alike.
bool are_ordinary(const BallFlight& a, const BallFlight& b, const Window& window) {
  return window.duration >= 0.0 && is_ordinary(a, window) && is_ordinary(b, window) &&
         0.5 * a.acceleration == 0.5 * b.acceleration;
}

/// `retreat_from_overlap` of two balls on parabolas, without poses.
double retreated(const Ball& a, const Ball& b, const Window& window, double t_lo) {
  const double reach = a.radius + b.radius;
  double back = ulp(t_lo);
  for (int attempt = 0; attempt < most_retreats && t_lo > 0.0; ++attempt) {
    const Instant t = window.start + t_lo;
    if (!((b.at(t - b.start) - a.at(t - a.start)).squaredNorm() <= reach * reach)) {
      break;
    }
    t_lo = std::max(0.0, t_lo - back);
    back *= 2.0;
  }
  return t_lo;
}

/// `retreat` moves `t_lo` earlier until the balls do not overlap there as poses have it.
template <typename Retreat>
TimeOfImpact impact_of(const Ball& a, const Ball& b, const Window& window, const Retreat& retreat) {
  const DistanceGap gap(a, b, window);
  TimeOfImpact toi = descent_answer(descent_of(gap, a, b), window.duration);
  if (toi.status == ToiStatus::separated) {
    return toi;
  }
  retreat(toi);
  const Vector3 at = gap.d + gap.v * toi.t_lo;
  const Vector3 centre_a = a.at((window.start + toi.t_lo) - a.start);
  toi.gap = std::max(0.0, at.norm() - gap.reach - gap.error(toi.t_lo));
  toi.normal = direction(at);
  toi.witness_a = centre_a + toi.normal * a.radius;
  toi.witness_b = centre_a + toi.normal * (at.norm() - b.radius);
  return toi;
}

}  // namespace

bool is_ordinary(const BallFlight& ball, const Window& window) {
  const double s0 = window.start - ball.start;
  const double s = s0 + window.duration;
  const double t = std::isfinite(s) ? s : 1.0;
  const double size = (0.5 * ball.acceleration.lpNorm<1>() * t + ball.velocity.lpNorm<1>()) * t +
                      ball.position.lpNorm<1>();
  return s0 >= 0.0 && size <= greatest_size && ball.radius >= least_extent &&
         ball.radius <= greatest_size;
}

std::optional<TimeOfImpact> sphere_sphere_impact(const BallFlight& of_a, const BallFlight& of_b,
                                                 const Window& window) {
  if (!are_ordinary(of_a, of_b, window)) {
    return std::nullopt;
  }
  const Ball a(of_a);
  const Ball b(of_b);
  return impact_of(a, b, window, [&](TimeOfImpact& toi) {
    if (toi.status != ToiStatus::overlapping) {
      toi.t_lo = retreated(a, b, window, toi.t_lo);
    }
  });
}

std::optional<BallMeeting> sphere_sphere_meeting(const BallFlight& of_a, const BallFlight& of_b,
                                                 const Window& window) {
  if (!are_ordinary(of_a, of_b, window)) {
    return std::nullopt;
  }
  const Ball a(of_a);
  const Ball b(of_b);
  // As `descent_answer` has it.
  const FirstDescent descent = descent_of(DistanceGap(a, b, window), a, b);
  if (descent.kind == Descent::none || descent.t_lo > window.duration) {
    return BallMeeting{.evaluations = 1};
  }
  if (descent.kind != Descent::found || !(descent.t_lo >= 0.0) ||
      !(descent.t_hi <= window.duration)) {
    return std::nullopt;
  }
  return BallMeeting{true, retreated(a, b, window, descent.t_lo), descent.t_hi, 1};
}

std::optional<TimeOfImpact> sphere_sphere_impact(const MovingShape& a, const MovingShape& b,
                                                 const Window& window) {
  if (!uniform(a, b)) {
    return std::nullopt;
  }
  return impact_of(Ball(a), Ball(b), window,
                   [&](TimeOfImpact& toi) { retreat_from_overlap(a, b, window, toi); });
}

std::optional<TimeOfImpact> sphere_sphere_separation(const MovingShape& a, const MovingShape& b,
                                                     const Window& window) {
  if (!uniform(a, b)) {
    return std::nullopt;
  }
  const DistanceGap gap(Ball(a), Ball(b), window);
  if (gap(0.0) > touch_band(a.motion, b.motion, gap.reach)) {
    return TimeOfImpact{};
  }
  TimeOfImpact toi = parting(gap, window);
  toi.normal = direction(gap.d + gap.v * (std::isfinite(toi.t_lo) ? toi.t_lo : 0.0));
  return toi;
}

}  // namespace kairos::ccd
