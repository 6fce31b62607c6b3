#include "ccd/quadratic_gap.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

/// Moves both ends of the bracket away from the root until the signs are proven. `earliest`: the
/// gap is known to be positive from there to the root; `latest`: it descends until there.
FirstDescent rounded_outwards(const QuadraticGap& gap, double root, double earliest,
                              double latest) {
  const double slope = std::abs(gap.rate(root));
  const double error = gap.error(root);
  const double margin = 2.0 * ulp(root) + (slope > 0.0 ? error / slope : 0.0);
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
  const double lowest = -discriminant / (4.0 * gap.c2);
  if (lowest > gap.error(lowest_at) + 2.0 * unit_roundoff * std::abs(lowest)) {
    return {Descent::none, 0.0, 0.0};
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
    return rounded_outwards(gap, -gap.c0 / gap.c1, 0.0, infinity);
  }
  return descent_of_convex(gap);
}

}  // namespace kairos::ccd
