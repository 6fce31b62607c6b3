#pragma once

#include "ccd/rounding/roundoff.hpp"

namespace kairos::ccd {

/// A gap c0 + c1 t + c2 t^2 (m) whose coefficients are known to within e0, e1, e2.
struct QuadraticGap {
  double c0 = 0.0, c1 = 0.0, c2 = 0.0;
  double e0 = 0.0, e1 = 0.0, e2 = 0.0;

  /// Value by compensated Horner: as if in twice the precision, then rounded [Langlois2007].
  [[nodiscard]] double operator()(double t) const {
    const Exact p1 = two_product(c2, t);
    const Exact s1 = two_sum(c1, p1.value);
    const Exact p0 = two_product(s1.value, t);
    const Exact s0 = two_sum(c0, p0.value);
    return s0.value + (s0.lost + p0.lost + (s1.lost + p1.lost) * t);
  }
  [[nodiscard]] double rate(double t) const { return c1 + 2.0 * c2 * t; }
  /// Bound of the error of the value at t.
  [[nodiscard]] double error(double t) const {
    // The compensated value itself is off by u |value| + 16 u^2 sum |c_k| t^k.
    const double size = std::abs(c0) + (std::abs(c1) + std::abs(c2) * t) * t;
    return e0 + (e1 + e2 * t) * t + 16.0 * unit_roundoff * unit_roundoff * size;
  }
};

/// What the first descent of a gap through zero looks like.
enum class Descent {
  none,      ///< the gap stays positive, errors included (or, from touch, never comes back)
  found,     ///< positive before t_lo (after leaving, if it starts in touch), negative at t_hi
  in_touch,  ///< starts within `touch` of zero and does not leave: approaching
  sliding,   ///< starts within `touch` of zero and stays there
  grazing,   ///< between t_lo and t_hi its sign is not known: zero to roundoff
  inside,    ///< starts below -touch
};
struct FirstDescent {
  Descent kind = Descent::none;
  double t_lo = 0.0;
  double t_hi = 0.0;
};

/// The last time of [low, high] up to which `gap(t) > gap.error(t)` holds, by bisection, for a gap
/// that is proven positive at `low` and descends. For brackets that rounding makes wide: grazes,
/// and roots so far away that the errors of the coefficients have grown large.
template <typename Gap>
[[nodiscard]] double last_proven(const Gap& gap, double low, double high) {
  double middle = low + 0.5 * (high - low);
  while (middle > low && middle < high) {  // roots may be 1e48 s away, and errors large long before
    (gap(middle) > gap.error(middle) ? low : high) = middle;
    middle = low + 0.5 * (high - low);
  }
  return low;
}

/// First time t > 0 at which the gap descends through zero. The roots are those of the numerically
/// stable formula with a compensated discriminant [Kahan2004], rounded outwards by two ulp and by
/// what the errors of the coefficients amount to, until the signs at t_lo and t_hi are proven;
/// there is none where (eq. 13) holds. `touch` (m): a gap within it of zero at the start is a
/// contact that began before.
[[nodiscard]] FirstDescent first_descent(const QuadraticGap& gap, double touch);

}  // namespace kairos::ccd
