#pragma once

#include "core/motion.hpp"

namespace kairos::ccd {

/// Translation of degree at most 2 in window time, or of one body against another:
/// c0 + c1 t + c2 t^2, each component of c_k known to within e_k.
struct Parabola {
  Vector3 c0, c1, c2;
  double e0 = 0.0, e1 = 0.0, e2 = 0.0;

  [[nodiscard]] Vector3 operator()(double t) const { return c0 + (c1 + c2 * t) * t; }
  [[nodiscard]] Vector3 rate(double t) const { return c1 + 2.0 * c2 * t; }
};

[[nodiscard]] inline bool is_parabola(const Motion& motion) {
  return motion.position.degree() <= 2;
}

/// The translation of b seen from a, with t = 0 at local times `s_a` and `s_b` of the motions;
/// both must be parabolas.
[[nodiscard]] Parabola relative_parabola(const Motion& a, double s_a, const Motion& b, double s_b);

}  // namespace kairos::ccd
