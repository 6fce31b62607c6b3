#include "core/drives/sinusoid.hpp"

#include "core/circular.hpp"
#include "core/exponential.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace kairos {
inline namespace core {
namespace {

constexpr int degree = 9;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr double tenth_factorial = 3628800.0;
/// Longest part of a period that one polynomial covers; its remainder is 2.4e-14 amplitudes.
constexpr double longest_part = 1.0 / 32.0;
/// Remainder allowed to the quaternion of a swing.
constexpr double quaternion_remainder = 1e-15;

using Series = std::array<double, degree + 1>;

/// sum_k S(10, k) x^k, S the Stirling numbers of the second kind: a bound of the tenth derivative
/// of exp(i x sin(theta)) by theta. By Faa di Bruno it is a sum over the partitions of the ten
/// derivatives, each block of which adds a factor of at most x [Comtet1974, sec. 3.3, 5.2].
double tenth_derivative_bound(double x) {
  constexpr double stirling[] = {1.0,     511.0,  9330.0, 34105.0, 42525.0,
                                 22827.0, 5880.0, 750.0,  45.0,    1.0};
  double sum = 0.0;
  for (int k = 9; k >= 0; --k) {
    sum = (sum + stirling[k]) * x;
  }
  return sum;
}

/// The part of a whole turn that f t is past, from an Instant: f t in double-double, less its
/// whole turns, which are exact.
double turns_at(double frequency, Instant t) {
  const double product = frequency * t.seconds;
  const double lost = std::fma(frequency, t.seconds, -product) + frequency * t.correction;
  return (product - std::floor(product)) + lost;
}

/// Taylor coefficients of sin(theta + w s) in s.
Series sine_series(double theta, double w) {
  const SineCosine at = sine_cosine(theta);
  const std::array<double, 4> cycle = {at.sine, at.cosine, -at.sine, -at.cosine};
  Series series;
  double factor = 1.0;
  for (std::size_t k = 0; k <= degree; ++k) {
    series[k] = cycle[k % 4] * factor;
    factor *= w / static_cast<double>(k + 1);
  }
  return series;
}

/// Taylor coefficients of cos(y(s)) and sin(y(s)), from (cos y)' = -y' sin y, (sin y)' = y' cos y.
std::pair<Series, Series> cosine_and_sine(const Series& y) {
  Series cosine{};
  Series sine{};
  const SineCosine at = sine_cosine(y[0]);
  cosine[0] = at.cosine;
  sine[0] = at.sine;
  for (std::size_t n = 1; n <= degree; ++n) {
    for (std::size_t k = 1; k <= n; ++k) {
      const double slope = static_cast<double>(k) / static_cast<double>(n) * y[k];
      cosine[n] -= slope * sine[n - k];
      sine[n] += slope * cosine[n - k];
    }
  }
  return {cosine, sine};
}

/// Makes `p` direction * series.
template <int Dim>
void set_along(Polynomial<Dim>& p, const Series& series,
               const typename Polynomial<Dim>::Value& direction) {
  p.resize(degree);
  for (int k = 0; k <= degree; ++k) {
    p[k] = direction * series[static_cast<std::size_t>(k)];
  }
}

Vector4 components(const Quaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

double longest_segment(double frequency, double half_swing) {
  double part = longest_part;
  if (half_swing > 0.0) {
    const double step = power(
        quaternion_remainder * tenth_factorial / tenth_derivative_bound(half_swing), 1.0 / 10.0);
    part = std::min(part, step / two_pi);
  }
  return part / frequency;
}

}  // namespace

Sinusoid::Sinusoid(const Options& options)
    : options_(options),
      turns_(options.rotation_amplitude != 0.0 && !options.rotation_axis.isZero(0.0)),
      segment_(longest_segment(options.frequency,
                               turns_ ? 0.5 * std::abs(options.rotation_amplitude) : 0.0)) {}

Motion Sinusoid::motion(Instant t, double at_most) const {
  const Options& o = options_;
  const double w = two_pi * o.frequency;
  const double turn = two_pi * turns_at(o.frequency, t);
  Motion motion;
  motion.start = t;
  motion.duration = std::min(at_most, segment_);
  motion.quaternion[0] = components(o.centre.orientation);

  const double theta = turn + o.phase;
  set_along<3>(motion.position, sine_series(theta, w), o.amplitude);
  motion.position[0] += o.centre.position;
  // Its own series, not the derivative of the position's: one order better.
  set_along<3>(motion.velocity, sine_series(theta + 0.5 * std::numbers::pi, w), o.amplitude * w);
  const double angle = w * motion.duration;
  const double fifth = angle * angle * angle * angle * angle;
  const double advance = fifth * fifth / tenth_factorial;
  const double amplitude = o.amplitude.norm();
  // The angle theta is wrong by a few ulp of its largest terms; the rest are roundings of sums.
  const double phase_error = 4.0 * eps * (two_pi + std::abs(o.phase));
  const double coordinates = o.centre.position.lpNorm<Eigen::Infinity>() + amplitude;
  motion.error_radius = amplitude * (1.001 * advance + phase_error) + 8.0 * eps * coordinates;
  if (!turns_) {
    return motion;
  }

  const double swing = turn + o.rotation_phase;
  Series half_angle = sine_series(swing, w);
  for (double& c : half_angle) {
    c *= 0.5 * o.rotation_amplitude;
  }
  const auto [cosine, sine] = cosine_and_sine(half_angle);
  const Quaternion& q = o.centre.orientation;
  const Vector3& axis = o.rotation_axis;
  const Quaternion turned = Quaternion(0.0, axis.x(), axis.y(), axis.z()) * q;
  const Vector4 along_q = components(q);
  const Vector4 along_turned = components(turned);
  motion.rotation = RotationKind::polynomial;
  motion.quaternion.resize(degree);
  for (int k = 0; k <= degree; ++k) {
    const auto at = static_cast<std::size_t>(k);
    motion.quaternion[k] = along_q * cosine[at] + along_turned * sine[at];
  }
  set_along<3>(motion.angular_velocity, sine_series(swing + 0.5 * std::numbers::pi, w),
               axis * (o.rotation_amplitude * w));
  // Two unit quaternions d apart turn a point at radius r by at most 4 d r asin-corrected; the
  // truncated one is normalised, which at most doubles its distance.
  const double half_swing = 0.5 * std::abs(o.rotation_amplitude);
  const double quaternion_error = tenth_derivative_bound(half_swing) * advance +
                                  half_swing * 4.0 * eps * (two_pi + std::abs(o.rotation_phase)) +
                                  8.0 * eps;
  motion.error_radius += 4.001 * quaternion_error * o.reach;
  return motion;
}

std::string Sinusoid::description() const {
  std::string text = fmt::format("sinusoid of {} Hz, amplitude {} m", options_.frequency,
                                 options_.amplitude.norm());
  if (turns_) {
    text += fmt::format(", swing {} rad", options_.rotation_amplitude);
  }
  return text;
}

}  // namespace core
}  // namespace kairos
