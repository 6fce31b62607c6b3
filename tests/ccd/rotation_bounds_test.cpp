// Bounds of angular speed and acceleration, against both in long double at many times.

#include "ccd/rotation_bounds.hpp"

#include "core/random.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace kairos;

namespace {

using Real = long double;
using Vec3 = Eigen::Matrix<Real, 3, 1>;
using Vec4 = Eigen::Matrix<Real, 4, 1, Eigen::DontAlign>;

/// Im(p q*).
Vec3 imaginary(const Vec4& p, const Vec4& q) {
  const Vec3 a(p[1], p[2], p[3]);
  const Vec3 b(q[1], q[2], q[3]);
  return q[0] * a - p[0] * b - a.cross(b);
}

struct Turn {
  Real speed;
  Real acceleration;
};

/// By the quotient rule, with no regard to the formula that the bounds come from.
Turn turn(const Polynomial<4>& q, Real s) {
  Vec4 value = Vec4::Zero();
  Vec4 first = Vec4::Zero();
  Vec4 second = Vec4::Zero();
  for (int k = q.degree(); k >= 0; --k) {
    second = second * s + 2.0L * first;
    first = first * s + value;
    value = value * s + q[k].cast<Real>();
  }
  const Real square = value.squaredNorm();
  const Vec3 moment = 2.0L * imaginary(first, value);
  const Vec3 change = 2.0L * (imaginary(second, value) + imaginary(first, first));
  const Vec3 alpha = change / square - moment * (2.0L * value.dot(first) / (square * square));
  return {moment.norm() / square, alpha.norm()};
}

/// exp(w s / 2) q as a Taylor polynomial of this degree.
Polynomial<4> constant_rate(const Vector3& w, const Vector4& q, int degree) {
  Polynomial<4> p;
  p.resize(degree);
  Quaternion term(q[0], q[1], q[2], q[3]);
  const Quaternion half(0.0, 0.5 * w.x(), 0.5 * w.y(), 0.5 * w.z());
  for (int k = 0; k <= degree; ++k) {
    p[k] = Vector4(term.w(), term.x(), term.y(), term.z());
    term = half * term;
    term.coeffs() /= k + 1;
  }
  return p;
}

Vector4 random_unit(Random& random) {
  return Vector4(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
}

Vector3 random_vector(Random& random, double size) {
  return size * Vector3(random.normal(), random.normal(), random.normal());
}

}  // namespace

TEST_CASE("rotation bounds: no angular speed or acceleration is above them", "[motion]") {
  constexpr std::uint64_t seed = 20261125;
  INFO("seed " << seed);
  Random random(seed);
  int finite = 0;
  for (int i = 0; i < 4000; ++i) {
    CAPTURE(i);
    const int degree = 1 + static_cast<int>(random.below(13));
    Motion motion;
    motion.duration = random.log_uniform(1e-6, 10.0);
    motion.rotation = RotationKind::polynomial;
    motion.quaternion =
        constant_rate(random_vector(random, random.log_uniform(1e-3, 3.0) / motion.duration),
                      random_unit(random), degree);
    // From dense outputs, which are nearly unit, to what hardly is a turn at all.
    const double noise = random.below(4) == 0 ? 0.0 : random.log_uniform(1e-16, 0.3);
    double scale = random.below(2) == 0 ? 1.0 : random.log_uniform(0.1, 10.0);
    for (int k = 0; k <= degree; ++k) {
      motion.quaternion[k] += scale * noise * random_unit(random);
      scale /= motion.duration;
    }
    for (int j = 0; j < 4; ++j) {
      const double length =
          random.below(4) == 0 ? 0.0 : random.log_uniform(1e-9, 1.0) * motion.duration;
      const double s0 = random.below(3) == 0 ? 0.0 : random.uniform() * (motion.duration - length);
      const double s1 = s0 + length;
      const ccd::RotationBounds bounds = ccd::rotation_bounds(motion, s0, s1);
      REQUIRE(bounds.speed >= 0.0);
      REQUIRE(bounds.acceleration >= 0.0);
      finite += std::isfinite(bounds.acceleration) ? 1 : 0;
      for (int sample = 0; sample <= 20; ++sample) {
        const Turn at = turn(motion.quaternion, s0 + (Real(s1) - s0) * sample / 20);
        REQUIRE(at.speed <= bounds.speed);
        REQUIRE(at.acceleration <= bounds.acceleration);
      }
    }
  }
  CHECK(finite > 12000);  // of 16,000: where |Q| may vanish there is no bound
}

TEST_CASE("rotation bounds: a turn at a constant rate has hardly any acceleration", "[motion]") {
  Motion motion;
  motion.duration = 1.0;
  motion.rotation = RotationKind::polynomial;
  motion.quaternion = constant_rate({0.3, -0.6, 0.4}, Vector4(0.5, -0.5, 0.5, 0.5), 8);
  const double rate = Vector3(0.3, -0.6, 0.4).norm();
  const ccd::RotationBounds bounds = ccd::rotation_bounds(motion, 0.0, 1.0);
  // The hull of an arc of .78 rad is .39^2 / 8 of its radius off it at most; the polynomial of
  // order 8 is off by (.39)^7 / 7! of itself in its second derivative.
  CHECK(bounds.speed <= 1.05 * rate);
  CHECK(bounds.acceleration <= 1e-5 * rate * rate);
  CHECK(ccd::rotation_bounds(motion, 0.5, 0.5).speed == Approx(rate).epsilon(1e-6));
}
