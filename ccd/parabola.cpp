#include "ccd/parabola.hpp"

#include "ccd/roundoff.hpp"

#include <cmath>

namespace kairos::ccd {
namespace {

Parabola parabola(const Motion& motion, double s) {
  const Polynomial<3>& p = motion.position;
  Parabola q{p[0], Vector3::Zero(), Vector3::Zero()};
  if (p.degree() > 0) {
    q.c1 = p[1];
  }
  if (p.degree() > 1) {
    q.c2 = p[2];
  }
  if (s != 0.0 && p.degree() > 0) {
    const double u = unit_roundoff;
    q.e0 = 5.0 * u *
           (q.c0.lpNorm<Eigen::Infinity>() +
            (q.c1.lpNorm<Eigen::Infinity>() + q.c2.lpNorm<Eigen::Infinity>() * s) * s);
    q.e1 = 3.0 * u * (q.c1.lpNorm<Eigen::Infinity>() + 2.0 * q.c2.lpNorm<Eigen::Infinity>() * s);
    q.c0 = q(s);
    q.c1 = q.rate(s);
  }
  return q;
}

/// Error of rounding x - y in every component; nothing is rounded where one side is zero.
double rounding(const Vector3& x, const Vector3& y, const Vector3& difference) {
  return x.isZero(0.0) || y.isZero(0.0) ? 0.0
                                        : unit_roundoff * difference.lpNorm<Eigen::Infinity>();
}

}  // namespace

Parabola relative_parabola(const Motion& a, double s_a, const Motion& b, double s_b) {
  const Parabola p = parabola(a, s_a);
  const Parabola q = parabola(b, s_b);
  Parabola d{q.c0 - p.c0, q.c1 - p.c1, q.c2 - p.c2};
  d.e0 = p.e0 + q.e0 + rounding(q.c0, p.c0, d.c0);
  d.e1 = p.e1 + q.e1 + rounding(q.c1, p.c1, d.c1);
  d.e2 = rounding(q.c2, p.c2, d.c2);
  return d;
}

}  // namespace kairos::ccd
