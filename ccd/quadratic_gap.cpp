#include "ccd/quadratic_gap.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

/// c less its error, from below; c itself where it is exact.
double from_below(double c, double e) {
  return e > 0.0 ? c - e - 2.0 * unit_roundoff * std::abs(c) : c;
}

/// The gap less its error, (c0 - e0) + (c1 - e1) t + (c2 - e2) t^2, is positive for all time (eq.
/// 13).
bool stays_positive(const QuadraticGap& gap) {
  const double a = from_below(gap.c0, gap.e0);
  const double b = from_below(gap.c1, gap.e1);
  const double c = from_below(gap.c2, gap.e2);
  if (!(a > gap.error(0.0)) || c < 0.0) {
    return false;
  }
  if (b >= 0.0) {
    return true;
  }
  if (!(c > 0.0)) {
    return false;
  }
  const double lowest = difference_of_products(4.0 * a, c, b, b) / (4.0 * c);
  const QuadraticGap exact{a, b, c, 0.0, 0.0, 0.0};
  return lowest > exact.error(-b / (2.0 * c)) + 4.0 * unit_roundoff * std::abs(lowest);
}

/// The gap is positive, but not if its error is subtracted: unknown from some time on.
FirstDescent lost_in_error(const QuadraticGap& gap) {
  const double b = from_below(gap.c1, gap.e1);
  const double c = from_below(gap.c2, gap.e2);
  if (b < 0.0 && c > 0.0) {  // for a while, around where what is left is least
    const double lowest_at = -b / (2.0 * c);
    const double t_lo = last_proven(gap, 0.0, lowest_at);
    return {Descent::grazing, t_lo, 2.0 * lowest_at - t_lo};
  }
  double later = 1.0;
  while (std::isfinite(later) && gap(later) > gap.error(later)) {
    later *= 4.0;
  }
  return std::isfinite(later)
             ? FirstDescent{Descent::grazing, last_proven(gap, 0.0, later), infinity}
             : FirstDescent{};
}

/// Moves both ends of the bracket away from the root until the signs are proven. `earliest`: the
/// gap is known to be positive from there to the root; `latest`: it descends until there.
FirstDescent rounded_outwards(const QuadraticGap& gap, double root, double earliest,
                              double latest) {
  if (!std::isfinite(root)) {  // at subnormal rates it comes later than any number tells
    return lost_in_error(gap);
  }
  const double slope = std::abs(gap.rate(root));
  const double error = gap.error(root);
  // How long the gap takes to change by its error: at this slope, or (from rest) by its curvature.
  const double by_slope = slope > 0.0 ? error / slope : 0.0;
  const double margin =
      2.0 * ulp(root) + (gap.c2 < 0.0 ? std::min(by_slope, std::sqrt(error / -gap.c2)) : by_slope);
  FirstDescent found{Descent::found, std::max(earliest, root - margin), root + margin};
  for (double wider = margin; found.t_lo > earliest && gap(found.t_lo) <= gap.error(found.t_lo);) {
    wider *= 2.0;
    found.t_lo = std::max(earliest, root - wider);
  }
  if (found.t_lo == earliest && gap(earliest) > gap.error(earliest)) {
    found.t_lo = last_proven(gap, earliest, root);
  }
  for (double wider = margin;
       found.t_hi < latest && gap(found.t_hi) > -gap.error(found.t_hi) && std::isfinite(wider);) {
    wider *= 2.0;
    found.t_hi = root + wider;
  }
  return found;
}

/// The gap opens upwards and approaches: it may dip below zero, graze it, or stay above.
FirstDescent descent_of_convex(const QuadraticGap& gap) {
  const double lowest_at = -gap.c1 / (2.0 * gap.c2);
  const double discriminant = difference_of_products(gap.c1, gap.c1, 4.0 * gap.c0, gap.c2);
  if (gap(lowest_at) > gap.error(lowest_at)) {
    return lost_in_error(gap);
  }
  const double root =
      discriminant > 0.0 ? 2.0 * gap.c0 / (-gap.c1 + std::sqrt(discriminant)) : lowest_at;
  FirstDescent found = rounded_outwards(gap, root, 0.0, lowest_at);
  if (!(found.t_hi < lowest_at) && !(gap(found.t_hi) < -gap.error(found.t_hi))) {
    found.kind = Descent::grazing;
    found.t_hi = std::max(found.t_hi, 2.0 * lowest_at - found.t_lo);
  }
  return found;
}

/// The gap opens downwards: exactly one descent, whatever the start.
FirstDescent descent_of_concave(const QuadraticGap& gap, bool in_touch) {
  // From touch the root is that of the flight: a start a little below zero must not make it short.
  const double c0 = in_touch ? std::max(0.0, gap.c0) : gap.c0;
  const double discriminant = difference_of_products(gap.c1, gap.c1, 4.0 * c0, gap.c2);
  const double root_of = std::sqrt(std::max(0.0, discriminant));
  const double root =
      gap.c1 > 0.0 ? -(gap.c1 + root_of) / (2.0 * gap.c2) : 2.0 * c0 / (-gap.c1 + root_of);
  const double apex = gap.c1 > 0.0 ? -gap.c1 / (2.0 * gap.c2) : 0.0;
  return rounded_outwards(gap, root, apex, infinity);
}

}  // namespace

FirstDescent first_descent(const QuadraticGap& gap, double touch) {
  if (gap.c0 < -touch) {
    return {Descent::inside, 0.0, 0.0};
  }
  const bool in_touch = gap.c0 <= gap.e0;
  if (in_touch) {
    const bool level = std::abs(gap.c1) <= gap.e1;
    if (gap.c1 < -gap.e1 || (level && gap.c2 < -gap.e2)) {
      return {Descent::in_touch, 0.0, 0.0};
    }
    if (level && std::abs(gap.c2) <= gap.e2) {
      return {Descent::sliding, 0.0, infinity};
    }
    if (gap.c2 >= gap.e2) {
      return {Descent::none, 0.0, 0.0};
    }
  } else if (stays_positive(gap)) {
    return {Descent::none, 0.0, 0.0};
  }
  if (gap.c2 < 0.0) {
    return descent_of_concave(gap, in_touch);
  }
  if (gap.c1 >= 0.0) {
    return lost_in_error(gap);
  }
  if (gap.c2 == 0.0) {
    return rounded_outwards(gap, -gap.c0 / gap.c1, 0.0, infinity);
  }
  return descent_of_convex(gap);
}

}  // namespace kairos::ccd
