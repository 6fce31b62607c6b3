#include "core/motion.hpp"

#include "core/circular.hpp"
#include "core/exponential.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double unit_roundoff = 0.5 * std::numeric_limits<double>::epsilon();

template <int Dim>
using Bernstein = std::array<typename Polynomial<Dim>::Value, Polynomial<Dim>::max_degree + 1>;

/// sum_{k >= first} |c_k| reach^k: every rounding error of a conversion to the Bernstein basis is
/// a small multiple of u times this.
template <int Dim>
double magnitude(const Polynomial<Dim>& p, double reach, int first) {
  double sum = 0.0;
  for (int k = p.degree(); k >= first; --k) {
    sum = sum * reach + p[k].norm();
  }
  return first == 0 ? sum : sum * power(reach, first);
}

/// Bound of the rounding error of every Bernstein coefficient on [s0, s1]: a Taylor shift, a
/// scaling and one sum, each of at most n + 1 terms: gamma_{6(n+1)} [Higham2002, sec. 3.1], doubled
/// to cover the roundings of the bound itself.
template <int Dim>
double conversion_error(const Polynomial<Dim>& p, double s0, double s1, int first) {
  const double reach = std::max(std::abs(s0), std::abs(s1)) + (s1 - s0);
  return 12.0 * (p.degree() + 1) * unit_roundoff * magnitude(p, reach, first);
}

/// Upper bound of |p| on [s0, s1], rounding included.
template <int Dim>
double norm_bound(const Polynomial<Dim>& p, double s0, double s1) {
  if (p.degree() == 0) {
    return p[0].norm() * (1.0 + 4.0 * unit_roundoff);
  }
  if (!std::isfinite(s1)) {
    return infinity;
  }
  Bernstein<Dim> b;
  bernstein(p, s0, s1, b);
  double largest = 0.0;
  for (int k = 0; k <= p.degree(); ++k) {
    largest = std::max(largest, b[static_cast<std::size_t>(k)].norm());
  }
  return largest * (1.0 + 8.0 * unit_roundoff) + conversion_error(p, s0, s1, 0);
}

/// Lower bound of |p| on [s0, s1]: the hull of the Bernstein coefficients seen along the direction
/// of their mean.
double norm_from_below(const Polynomial<4>& p, double s0, double s1) {
  Bernstein<4> b;
  bernstein(p, s0, s1, b);
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
  return std::max(0.0, least * (1.0 - 16.0 * unit_roundoff) - 2.0 * conversion_error(p, s0, s1, 0));
}

/// Polynomial p without its trailing zero coefficients, so that a body at rest costs nothing.
Polynomial<3> trimmed(Polynomial<3> p) {
  int degree = p.degree();
  while (degree > 0 && p[degree].isZero(0.0)) {
    --degree;
  }
  p.resize(degree);
  return p;
}

/// |w| s / 2 as an unevaluated sum: after many turns a plain product would cost the orientation one
/// bit per doubling of the angle.
struct Angle {
  double high;
  double low;
};

Angle half_angle(const Vector3& w, double rate, double s) {
  const double plain = 0.5 * rate * s;
  if (std::abs(plain) < 2.0) {
    return {plain, 0.0};
  }
  // One Newton correction of the square root with an exact residual |w|^2 - rate^2.
  double residual = -rate * rate;
  double low = -std::fma(rate, rate, residual);
  for (const double x : {w.x(), w.y(), w.z()}) {
    const double square = x * x;
    low += std::fma(x, x, -square);
    const double sum = residual + square;
    const double z = sum - residual;
    low += (residual - (sum - z)) + (square - z);
    residual = sum;
  }
  const double rate_low = (residual + low) / (2.0 * rate);
  const double half_s = 0.5 * s;
  return {plain, std::fma(rate, half_s, -plain) + rate_low * half_s};
}

/// Up to this angle the sine is the angle and the cosine 1, in doubles.
constexpr double first_order = 1e-8;

}  // namespace

Motion Motion::at_rest(Instant start, const Pose& pose) {
  return ballistic(start, infinity, pose, Twist{}, Vector3::Zero());
}

Motion Motion::ballistic(Instant start, double duration, const Pose& pose, const Twist& twist,
                         const Vector3& acceleration) {
  Motion motion;
  motion.start = start;
  motion.duration = duration;
  motion.position =
      trimmed(Polynomial<3>(pose.position, twist.linear, Vector3(0.5 * acceleration)));
  motion.velocity = trimmed(Polynomial<3>(twist.linear, acceleration));
  motion.rotation = twist.angular.isZero(0.0) ? RotationKind::fixed : RotationKind::constant_rate;
  const Quaternion& q = pose.orientation;
  motion.quaternion[0] = Vector4(q.w(), q.x(), q.y(), q.z());
  motion.rotation_rate = twist.angular;
  motion.angular_velocity[0] = twist.angular;
  return motion;
}

Pose Motion::pose(double s) const { return {position(s), orientation(s)}; }

Quaternion Motion::orientation(double s) const {
  const Vector4& c = quaternion[0];
  switch (rotation) {
    case RotationKind::fixed:
      return {c[0], c[1], c[2], c[3]};
    case RotationKind::constant_rate: {
      const Quaternion q(c[0], c[1], c[2], c[3]);
      const Vector3& w = rotation_rate;
      const double rate = w.norm();
      if (!(rate > 0.0)) {
        return q;
      }
      const Angle half = half_angle(w, rate, s);
      const SineCosine high = sine_cosine(half.high);
      double sine = high.sine;
      double cosine = high.cosine;
      if (std::abs(half.low) > first_order) {  // beyond some 1e8 rad
        const SineCosine low = sine_cosine(half.low);
        sine = high.sine * low.cosine + high.cosine * low.sine;
        cosine = high.cosine * low.cosine - high.sine * low.sine;
      } else {
        sine += high.cosine * half.low;
        cosine -= high.sine * half.low;
      }
      const double k = sine / rate;
      return Quaternion(cosine, k * w.x(), k * w.y(), k * w.z()) * q;
    }
    case RotationKind::polynomial:
      break;
  }
  Vector4 q = quaternion(s);
  const double square = q.squaredNorm();
  // A quaternion that is unit to roundoff already is left as it is, bit for bit.
  if (std::abs(square - 1.0) > 8.0 * unit_roundoff) {
    q /= std::sqrt(square);
  }
  return {q[0], q[1], q[2], q[3]};
}

Twist Motion::twist(double s) const {
  return {velocity(s),
          rotation == RotationKind::fixed ? Vector3::Zero().eval() : Vector3(angular_velocity(s))};
}

Motion Motion::shifted(double s0) const {
  Motion later = *this;
  later.start = start + s0;
  later.duration = duration - s0;
  later.position = position.shifted(s0);
  later.velocity = velocity.shifted(s0);
  later.angular_velocity = angular_velocity.shifted(s0);
  if (rotation == RotationKind::constant_rate) {
    const Quaternion q = orientation(s0).normalized();
    later.quaternion[0] = Vector4(q.w(), q.x(), q.y(), q.z());
  } else if (rotation == RotationKind::polynomial) {
    later.quaternion = quaternion.shifted(s0);
  }
  return later;
}

double Motion::speed_bound(double s0, double s1) const {
  return norm_bound(position.differentiated(), s0, s1);
}

double Motion::displacement_bound(double s0, double s1) const {
  if (position.degree() == 0 || s1 == s0) {
    return 0.0;
  }
  if (!std::isfinite(s1)) {
    return infinity;
  }
  const double by_speed = speed_bound(s0, s1) * (s1 - s0) * (1.0 + 4.0 * unit_roundoff);
  Bernstein<3> b;
  Polynomial<3> from_start = position;
  from_start[0].setZero();
  bernstein(from_start, s0, s1, b);
  double largest = 0.0;
  for (int k = 1; k <= position.degree(); ++k) {
    largest = std::max(largest, (b[static_cast<std::size_t>(k)] - b[0]).norm());
  }
  const double by_hull =
      largest * (1.0 + 8.0 * unit_roundoff) + 2.0 * conversion_error(from_start, s0, s1, 1);
  return std::min(by_speed, by_hull);
}

double Motion::angular_speed_bound(double s0, double s1) const {
  switch (rotation) {
    case RotationKind::fixed:
      return 0.0;
    case RotationKind::constant_rate:
      return rotation_rate.norm() * (1.0 + 4.0 * unit_roundoff);
    case RotationKind::polynomial:
      break;
  }
  if (quaternion.degree() == 0) {
    return 0.0;
  }
  if (!std::isfinite(s1)) {
    return infinity;
  }
  const double least = norm_from_below(quaternion, s0, s1);
  if (!(least > 0.0)) {
    return infinity;
  }
  const double rate = norm_bound(quaternion.differentiated(), s0, s1);
  return 2.0 * rate / least * (1.0 + 8.0 * unit_roundoff);
}

template <int Dim>
void bernstein(const Polynomial<Dim>& p, double s0, double s1,
               std::array<typename Polynomial<Dim>::Value, Polynomial<Dim>::max_degree + 1>& out) {
  const int n = p.degree();
  if (s1 == s0) {
    std::fill_n(out.begin(), n + 1, p(s0));
    return;
  }
  const Polynomial<Dim> shifted = s0 == 0.0 ? p : p.shifted(s0);
  // Scaled to [0, 1] and divided by C(n, k): b_j = sum_k C(j, k) a_k [Farouki2012, sec. 2.4].
  double scale = 1.0;
  for (int k = 0; k <= n; ++k) {
    out[static_cast<std::size_t>(k)] = shifted[k] * scale;
    scale *= (s1 - s0) * (k + 1) / (n - k > 0 ? n - k : 1);
  }
  // The sums with binomial weights by repeated addition, as in Pascal's triangle.
  for (int level = 1; level <= n; ++level) {
    for (int k = n; k >= level; --k) {
      out[static_cast<std::size_t>(k)] += out[static_cast<std::size_t>(k - 1)];
    }
  }
}

template void bernstein<3>(const Polynomial<3>&, double, double,
                           std::array<Polynomial<3>::Value, Polynomial<3>::max_degree + 1>&);
template void bernstein<4>(const Polynomial<4>&, double, double,
                           std::array<Polynomial<4>::Value, Polynomial<4>::max_degree + 1>&);

}  // namespace core
}  // namespace kairos
