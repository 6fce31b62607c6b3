#include "experiments/accuracy/query.hpp"

namespace kairos::reference {

Real reference_error(const Query& q) {
  const auto size = [](const Shape& shape) {
    const double r = bounding_radius(shape);
    return std::isfinite(r) ? r : 0.0;
  };
  Real d = relative_position(q.motion_a, 0, q.motion_b, 0).norm();
  Real power = 1;
  for (int k = 1; k <= std::max(q.motion_a.position.degree(), q.motion_b.position.degree()); ++k) {
    power *= q.duration;
    for (const Motion* motion : {&q.motion_a, &q.motion_b}) {
      d += k <= motion->position.degree() ? motion->position[k].norm() * power : Real(0);
    }
  }
  return 64 * std::numeric_limits<Real>::epsilon() * (d + size(q.a) + size(q.b));
}

std::string broken_promise(const Query& q, const TimeOfImpact& toi, int samples) {
  const Real e = reference_error(q);
  const double tolerance = ccd::default_tolerance(q.moving_a(), q.moving_b(), q.window());
  const auto f = [&q](Real t) { return q.separation(t); };
  if (!std::isfinite(toi.t_lo) || !(toi.t_lo >= 0.0) || !(toi.t_hi >= toi.t_lo) ||
      toi.t_hi > q.duration) {
    return "bracket is not within the window";
  }
  if (toi.status == ToiStatus::overlapping) {
    return f(0) > e ? "not overlapping at the start" : "";
  }
  // A start in touch, to roundoff of doubles, is a contact that began before: what counts is from
  // when they have left.
  Real from = 0;
  const Real touch = f(0) <= 2048 * e ? 2048 * e : e;  // 2048 long double roundings are one of ours
  while (f(from) <= touch && from < toi.t_lo) {
    from = from == 0 ? Real(1e-12) * q.duration : 2 * from;
  }
  if (from < toi.t_lo && least(f, from, toi.t_lo, samples) < -e) {
    return toi.status == ToiStatus::separated ? "contact missed" : "late";
  }
  if (toi.status == ToiStatus::separated) {
    return toi.t_lo == q.duration ? "" : "separated before the end of the window";
  }
  const bool out_of_work = toi.status == ToiStatus::undecided && toi.t_lo > 0.0 &&
                           toi.t_hi == toi.t_lo && toi.evaluations >= 20'000;
  if (f(toi.t_lo) > tolerance + e && !out_of_work) {
    return "gap at t_lo above the tolerance";
  }
  if (toi.gap < 0.0 || toi.gap > std::max(Real(0), f(toi.t_lo)) * (1 + Real(1e-6)) + e) {
    return "gap is not the distance from below";
  }
  if (std::abs(toi.normal.norm() - 1.0) > 1e-12) {  // 1e4 roundings: a few are made
    return "normal is not unit";
  }
  // The start may be in touch to roundoff of doubles: approaching from there is a contact by t_hi.
  if (toi.status == ToiStatus::impact && toi.t_hi > 0.0 && f(toi.t_hi) > e) {
    return "no contact at t_hi";
  }
  return "";
}

}  // namespace kairos::reference
