#include "ccd/rotation_bounds.hpp"

#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;

using Hull = std::array<Vector4, Polynomial<4>::max_degree + 1>;

/// Q in time from s0 on, for an interval of length h; of a point no more than it takes: Q, Q', Q''.
Polynomial<4> seen_from(const Polynomial<4>& q, double s0, double h) {
  Polynomial<4> r = q;
  const int passes = h > 0.0 ? q.degree() : std::min(q.degree(), 3);
  if (s0 != 0.0) {
    for (int i = 0; i < passes; ++i) {
      for (int k = q.degree() - 1; k >= i; --k) {
        r[k] += r[k + 1] * s0;
      }
    }
  }
  if (!(h > 0.0)) {
    r.resize(std::min(q.degree(), 2));
  }
  return r;
}

/// Largest norm of Bernstein coefficients on [0, h].
double largest_norm(const Polynomial<4>& p, double h) {
  Hull b;
  bernstein(p, 0.0, h, b);
  double square = 0.0;
  for (int k = 0; k <= p.degree(); ++k) {
    square = std::max(square, b[static_cast<std::size_t>(k)].squaredNorm());
  }
  return std::sqrt(square) * (1.0 + 8.0 * u);
}

/// Least of Bernstein coefficients on [0, h] along the direction of their mean.
double least_norm(const Polynomial<4>& p, double h) {
  Hull b;
  bernstein(p, 0.0, h, b);
  Vector4 mean = Vector4::Zero();
  for (int k = 0; k <= p.degree(); ++k) {
    mean += b[static_cast<std::size_t>(k)];
  }
  const double length = mean.norm();
  if (!(length > 0.0)) {
    return 0.0;
  }
  const Vector4 direction = mean / length;
  double least = infinity;
  for (int k = 0; k <= p.degree(); ++k) {
    least = std::min(least, direction.dot(b[static_cast<std::size_t>(k)]));
  }
  return least * (1.0 - 16.0 * u);
}

/// sum |c_k| x^k and its first two derivatives: what roundings are parts of.
std::array<double, 3> magnitudes(const Polynomial<4>& p, double x) {
  std::array<double, 3> m{};
  for (int k = p.degree(); k >= 0; --k) {
    m[2] = m[2] * x + 2.0 * m[1];
    m[1] = m[1] * x + m[0];
    m[0] = m[0] * x + p[k].norm();
  }
  return m;
}

/// Bound of |p . p'| on [0, h], but for roundings: half of |d |p|^2 / ds|.
double product_with_derivative(const Polynomial<4>& p, double h) {
  const int n = p.degree();
  double sum = 0.0;
  for (int k = 2 * n; k >= 1; --k) {
    double coefficient = 0.0;  // of |p|^2, half of it: its terms come in pairs
    for (int i = std::max(0, k - n); 2 * i < k; ++i) {
      coefficient += p[i].dot(p[k - i]);
    }
    if (k % 2 == 0) {
      coefficient += 0.5 * p[k / 2].squaredNorm();
    }
    sum = sum * h + k * std::abs(coefficient);
  }
  return sum;
}

/// p'' + c p.
Polynomial<4> bent_against(const Polynomial<4>& p, double c) {
  Polynomial<4> sum;
  sum.resize(p.degree());
  for (int k = 0; k <= p.degree(); ++k) {
    sum[k] = p[k] * c;
    if (k + 2 <= p.degree()) {
      sum[k] += p[k + 2] * ((k + 2) * (k + 1));
    }
  }
  return sum;
}

RotationBounds of_polynomial(const Polynomial<4>& quaternion, double s0, double s1) {
  const double h = s1 - s0;
  const Polynomial<4> q = seen_from(quaternion, s0, h);
  const Polynomial<4> first = q.differentiated();

  // A Taylor shift, a product with k, a conversion: each at most n + 1 terms of the magnitudes,
  // twice over for the roundings of the bound [Higham2002, sec. 3.1].
  const auto m = magnitudes(quaternion, std::abs(s0) + 2.0 * h);
  const double rounding = 24.0 * (quaternion.degree() + 1) * u;

  const double least = least_norm(q, h) - rounding * m[0];
  if (!(least > 0.0)) {
    return {infinity, infinity};
  }
  const double rate = largest_norm(first, h) + rounding * m[1];
  const double speed = 2.0 * rate / least * (1.0 + 8.0 * u);

  const Vector4 middle = q(0.5 * h);
  const double c = std::max(0.0, -middle.dot(first.derivative(0.5 * h)) / middle.squaredNorm());
  const double across = largest_norm(bent_against(q, c), h) + rounding * (m[2] + c * m[0]);
  const double along = product_with_derivative(q, h) + 2.0 * rounding * m[0] * m[1];
  return {speed, (2.0 * across + 2.0 * along * speed / least) / least * (1.0 + 16.0 * u)};
}

}  // namespace

RotationBounds rotation_bounds(const Motion& motion, double s0, double s1) {
  if (motion.rotation != RotationKind::polynomial) {
    return {motion.angular_speed_bound(s0, s1), 0.0};
  }
  if (motion.quaternion.degree() == 0) {
    return {};
  }
  if (!std::isfinite(s1)) {
    return {infinity, infinity};
  }
  return of_polynomial(motion.quaternion, s0, s1);
}

}  // namespace kairos::ccd
