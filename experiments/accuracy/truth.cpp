#include "experiments/accuracy/truth.hpp"

namespace kairos::reference {
namespace {

/// No point of one shape moves faster against the other, m/s; infinite where that is unknown.
Real greatest_speed(const Query& q) {
  const auto radius = [](const Shape& shape) {
    const double r = bounding_radius(shape);
    return std::isfinite(r) ? Real(r) : Real(0);
  };
  Real speed = 0;
  for (int k = 1; k <= std::max(q.motion_a.position.degree(), q.motion_b.position.degree()); ++k) {
    Vec c = Vec::Zero();
    if (k <= q.motion_b.position.degree()) {
      c = q.motion_b.position[k].cast<Real>();
    }
    if (k <= q.motion_a.position.degree()) {
      c -= q.motion_a.position[k].cast<Real>();
    }
    speed += k * c.norm() * std::pow(Real(q.duration), Real(k - 1));
  }
  const Real w_a = q.motion_a.angular_speed_bound(0.0, q.duration);
  const Real w_b = q.motion_b.angular_speed_bound(0.0, q.duration);
  // A plane that turns carries with it all that is above it: lever arms reach as far as the bodies.
  Real reach = 0;
  for (int k = 0; k <= std::max(q.motion_a.position.degree(), q.motion_b.position.degree()); ++k) {
    reach += (k <= q.motion_a.position.degree() ? Real(q.motion_a.position[k].norm()) : Real(0)) *
             std::pow(Real(q.duration), Real(k));
    reach += (k <= q.motion_b.position.degree() ? Real(q.motion_b.position[k].norm()) : Real(0)) *
             std::pow(Real(q.duration), Real(k));
  }
  const bool plane_turns = std::holds_alternative<HalfSpace>(q.b.index() == 2 ? q.b : q.a) &&
                           (q.b.index() == 2 ? w_b : w_a) > 0;
  const Real lever = plane_turns ? reach + radius(q.a) + radius(q.b) : Real(0);
  return (speed + w_a * (q.a.index() == 1 ? radius(q.a) : Real(0)) +
          w_b * (q.b.index() == 1 ? radius(q.b) : Real(0)) +
          (plane_turns ? (q.b.index() == 2 ? w_b : w_a) * lever : Real(0))) *
         (1 + Real(1e-12));
}

}  // namespace

Truth find_truth(const Query& q, int steps, int samples) {
  Truth truth;
  const Real e = reference_error(q);
  const auto f = [&q](Real t) { return q.separation(t); };
  const Real end = q.duration;
  Real gap = f(0);
  if (gap <= e) {
    truth.overlapping = true;
    return truth;
  }
  const Real near = Real(1e-11) * std::min(smallest_extent(q.a), smallest_extent(q.b)) + 64 * e;
  const Real speed = greatest_speed(q);
  Real t = 0;
  for (int n = 0; n < steps && gap > near; ++n) {
    t += std::isfinite(speed) && speed > 0 ? gap / speed : (speed > 0 ? Real(0) : end);
    if (t >= end) {
      truth.touch = end;
      return truth;
    }
    gap = f(t);
  }
  truth.touch = t;
  // From here on: the first sample below zero, between ever longer steps, then bisection.
  Real outside = t;
  Real inside = -1;
  Real step = std::max((end - t) * Real(1e-13), t * Real(1e-18));
  for (Real s = t; s < end && inside < 0;) {
    s = std::min(end, s + step);
    const Real x = f(s);
    (x < -e ? inside : outside) = s;
    step = std::min(2 * step, (end - t) / samples);
  }
  if (inside < 0) {
    // No sample is inside: perhaps the lowest of them stands beside a graze.
    truth.contact = least(f, t, end, samples) < -e;
    truth.time = t;
    return truth;
  }
  truth.contact = true;
  for (int n = 0; n < 80; ++n) {
    const Real middle = (outside + inside) / 2;
    (f(middle) < -e ? inside : outside) = middle;
  }
  truth.time = inside;
  return truth;
}

Finding judge(const Query& q, const TimeOfImpact& toi, const Truth& truth, double tolerance,
              bool proves) {
  const Real e = reference_error(q);
  if (truth.overlapping || toi.status == ToiStatus::overlapping) {
    return truth.overlapping == (toi.status == ToiStatus::overlapping) ||
                   std::abs(q.separation(0)) <= Real(tolerance)
               ? Finding::right
               : Finding::wrong;
  }
  if (toi.status == ToiStatus::separated) {
    return truth.contact ? Finding::missed : Finding::right;
  }
  if (toi.t_lo > truth.touch) {
    const auto f = [&q](Real t) { return q.separation(t); };
    if (least(f, truth.touch, toi.t_lo, 50) < -(proves ? e : Real(tolerance))) {
      return Finding::late;
    }
  }
  const bool far = q.separation(toi.t_lo) > Real(tolerance) + e;
  const bool no_contact = toi.status == ToiStatus::impact && q.separation(toi.t_hi) > e;
  return proves && (far || no_contact) ? Finding::wrong : Finding::right;
}

}  // namespace kairos::reference
