// One contact with friction, against the conditions that define its solution.

#include "core/contacts/coulomb_cone.hpp"

#include "core/random.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <limits>

using namespace kairos;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The compliance of a point of a free body: 1/m - [r] I^-1 [r], turned at random.
Matrix3 random_compliance(Random& random) {
  const Vector3 r = random.direction() * random.uniform(0.0, 2.0);
  Matrix3 cross;
  cross << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
  const Vector3 inverse(random.log_uniform(0.1, 10.0), random.log_uniform(0.1, 10.0),
                        random.log_uniform(0.1, 10.0));
  const Matrix3 turn = rotate(random.direction() * random.uniform(0.0, 3.0), Quaternion::Identity())
                           .toRotationMatrix();
  const Matrix3 W =
      random.log_uniform(0.1, 10.0) * Matrix3::Identity() - cross * inverse.asDiagonal() * cross;
  return turn * W * turn.transpose();
}

}  // namespace

TEST_CASE("the impulse of a contact satisfies Coulomb's law on the exact cone", "[friction]") {
  Random random(20261122);
  INFO("seed 20261122");
  int apart = 0, sticks = 0, slides = 0;
  for (int trial = 0; trial < 20'000; ++trial) {
    const Matrix3 W = random_compliance(random);
    const Vector3 q = random.direction() * random.log_uniform(1e-3, 1e3);
    const double mu = trial % 10 == 0 ? 0.0 : random.log_uniform(0.01, 3.0);
    const Vector3 p = coulomb_impulse(W, q, mu);
    const Vector3 u = W * p + q;
    // A root to roundoff of an angle, felt by velocities as large as q: solver, 1e-9.
    const double tolerance = 1e-9 * q.norm() * (1.0 + mu);
    const double slip = u.tail<2>().norm();
    const double pushed = p.tail<2>().norm();
    CAPTURE(trial, mu, W, q.transpose(), p.transpose(), u.transpose());
    REQUIRE(p[0] >= 0.0);
    REQUIRE(u[0] >= -tolerance);
    REQUIRE(p[0] * u[0] <= tolerance * p[0]);
    REQUIRE(pushed <= mu * p[0] * (1.0 + 1e-12));
    if (p[0] == 0.0) {
      ++apart;
    } else if (slip <= tolerance) {
      ++sticks;
    } else {
      ++slides;
      // Against the slip and as much as there is: p_t + mu p_n u_t/|u_t| = 0.
      const Eigen::Vector2d rest = p.tail<2>() + mu * p[0] * u.tail<2>() / slip;
      REQUIRE(rest.norm() * slip <= tolerance * (pushed + mu * p[0]));
    }
  }
  CHECK(apart > 1000);
  CHECK(sticks > 1000);
  CHECK(slides > 1000);
}

TEST_CASE("a rough contact sticks, a smooth one has no friction", "[friction]") {
  const Matrix3 W = Matrix3::Identity();
  const Vector3 q(-1.0, 30.0, -40.0);
  CHECK((coulomb_impulse(W, q, infinity) + q).norm() <= 1e-12);
  CHECK(coulomb_impulse(W, q, 0.0) == Vector3(1.0, 0.0, 0.0));
  // Isotropic: 3-4-5 in the plane.
  CHECK((coulomb_impulse(W, q, 0.5) - Vector3(1.0, -0.3, 0.4)).norm() <= 1e-12);
  CHECK(coulomb_impulse(W, {0.0, 1.0, 0.0}, 0.5) == Vector3::Zero());
}

TEST_CASE("the impulse of a contact at which joints block a direction", "[friction]") {
  Random random(20261124);
  INFO("seed 20261124");
  int sticks = 0, slides = 0, locks = 0;
  for (int trial = 0; trial < 5'000; ++trial) {
    // A point that moves on a line or on a plane, told along axes of which one is blocked, or not.
    Matrix3 W = Matrix3::Zero();
    Vector3 q = Vector3::Zero();
    const int kind = trial % 3;
    const Vector3 d = random.direction();
    if (kind == 0) {  // a plane across the second tangent
      W.topLeftCorner<2, 2>() = random_compliance(random).topLeftCorner<2, 2>();
      q.head<2>() = Eigen::Vector2d(random.uniform(-1.0, 0.2), random.uniform(-1.0, 1.0));
    } else if (kind == 1) {  // a line across the second tangent
      const Vector3 line = Vector3(d.x(), d.y(), 0.0).normalized();
      W = 2.0 * line * line.transpose();
      q = line * random.uniform(-1.0, 1.0);
    } else {  // any plane
      W = Matrix3::Identity() - d * d.transpose();
      const Vector3 some = random.direction();
      q = some - d * d.dot(some);
    }
    const double mu = random.log_uniform(0.05, 3.0);
    const Vector3 p = coulomb_impulse(W, q, mu);
    const Vector3 u = W * p + q;
    const double tolerance = 1e-9 * (q.norm() + p.norm()) * (1.0 + mu);
    const double slip = u.tail<2>().norm();
    CAPTURE(trial, mu, W, q.transpose(), p.transpose(), u.transpose());
    REQUIRE(p[0] >= 0.0);
    REQUIRE(u[0] >= -tolerance);
    REQUIRE(p[0] * u[0] <= tolerance * p[0]);
    REQUIRE(p.tail<2>().norm() <= mu * p[0] * (1.0 + 1e-12));
    if (p[0] > 0.0 && slip > tolerance) {
      ++slides;
      const Eigen::Vector2d rest = p.tail<2>() + mu * p[0] * u.tail<2>() / slip;
      REQUIRE(rest.norm() * slip <= tolerance * (p.tail<2>().norm() + mu * p[0]));
    } else if (p[0] > 0.0) {
      ++(kind == 0 ? sticks : locks);
    }
  }
  CHECK(sticks > 100);
  CHECK(slides > 10);
  CHECK(locks > 100);
}
