#include "ccd/quadratic_gap.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

/// Moves both ends of the bracket away from the root until the signs are proven. `earliest`: the
/// gap is known to be positive from there to the root.
FirstDescent rounded_outwards(const QuadraticGap& gap, double root, double earliest) {
  const double slope = std::abs(gap.rate(root));
  const double error = gap.error(root);
  const double margin = 2.0 * ulp(root) + (slope > 0.0 ? error / slope : 0.0);
  FirstDescent found{Descent::found, std::max(earliest, root - margin), root + margin};
  for (double wider = margin; found.t_lo > earliest && gap(found.t_lo) <= gap.error(found.t_lo);) {
    wider *= 2.0;
    found.t_lo = std::max(earliest, root - wider);
  }
  for (double wider = margin; std::isfinite(wider) && gap(found.t_hi) > -gap.error(found.t_hi);) {
    wider *= 2.0;
    found.t_hi = root + wider;
  }
  return found;
}

/// The gap opens upwards and approaches: it may dip below zero, graze it, or stay above.
FirstDescent descent_of_convex(const QuadraticGap& gap) {
  const double lowest_at = -gap.c1 / (2.0 * gap.c2);
  const double discriminant = difference_of_products(gap.c1, gap.c1, 4.0 * gap.c0, gap.c2);
  const double lowest = -discriminant / (4.0 * gap.c2);
  const double error = gap.error(lowest_at) + 2.0 * unit_roundoff * std::abs(lowest);
  if (lowest > error) {
    return {Descent::none, 0.0, 0.0};
  }
  if (lowest >= -error) {
    // gap <= 2 error within sqrt(3 error / c2) of the lowest point.
    const double half_width = std::sqrt(3.0 * error / gap.c2) + 2.0 * ulp(lowest_at);
    return {Descent::grazing, std::max(0.0, lowest_at - half_width), lowest_at + half_width};
  }
  return rounded_outwards(gap, 2.0 * gap.c0 / (-gap.c1 + std::sqrt(discriminant)), 0.0);
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
  return rounded_outwards(gap, root, apex);
}

}  // namespace

FirstDescent first_descent(const QuadraticGap& gap, double touch) {
  if (gap.c0 < -touch) {
    return {Descent::inside, 0.0, 0.0};
  }
  const bool in_touch = gap.c0 <= gap.e0;
  if (in_touch) {
    if (gap.c1 < 0.0 || (gap.c1 == 0.0 && gap.c2 < 0.0)) {
      return {Descent::in_touch, 0.0, 0.0};
    }
    if (gap.c1 == 0.0 && gap.c2 == 0.0) {
      return {Descent::sliding, 0.0, infinity};
    }
    if (gap.c2 >= 0.0) {
      return {Descent::none, 0.0, 0.0};
    }
  }
  if (gap.c2 < 0.0) {
    return descent_of_concave(gap, in_touch);
  }
  if (gap.c1 >= 0.0) {
    return {Descent::none, 0.0, 0.0};
  }
  if (gap.c2 == 0.0) {
    return rounded_outwards(gap, -gap.c0 / gap.c1, 0.0);
  }
  return descent_of_convex(gap);
}

}  // namespace kairos::ccd
