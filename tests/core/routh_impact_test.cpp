// One contact with friction during an impact, against closed forms and what defines it.

#include "core/contacts/routh_impact.hpp"

#include "core/contacts/contact_system.hpp"
#include "core/random.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <utility>

using namespace kairos;

namespace {

/// 1/kg, of a body of mass 1 against what does not move, pushed at an arm.
Matrix3 felt(const Vector3& arm, const Vector3& moments, const Matrix3& axes) {
  Matrix3 levers;
  for (int k = 0; k < 3; ++k) {
    levers.col(k) = arm.cross(axes.col(k));
  }
  return Matrix3::Identity() + levers.transpose() * moments.cwiseInverse().asDiagonal() * levers;
}

/// Axes n, t1, t2 of a floor.
Matrix3 floor_axes() {
  Matrix3 axes;
  axes.col(0) = Vector3::UnitY();
  axes.col(1) = Vector3::UnitX();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

/// A plate of 1 kg with half-extents a, b (in the plane), its long axis at an angle, on a corner.
Matrix3 on_corner(double a, double b, double angle) {
  const double inertia = (a * a + b * b) / 3.0;
  const Vector3 arm(-a * std::cos(angle) + b * std::sin(angle),
                    -a * std::sin(angle) - b * std::cos(angle), 0.0);
  return felt(arm, {1e30, 1e30, inertia}, floor_axes());
}

}  // namespace

TEST_CASE("routh 12: a box hits with a corner, and its sliding is reversed", "[routh][reference]") {
  const Matrix3 W = on_corner(0.5, 0.1, 40.0 * M_PI / 180.0);
  const Vector3 before(-2.0, 1.0, 0.0);
  const RouthImpact impact = routh_impact(W, before, 0.3, 0.5);
  REQUIRE(impact.solved);
  CHECK(std::abs(impact.velocity[1] + 0.611988689090) <= 1e-12);
  CHECK(std::abs(impact.velocity[0] - 0.852878799699) <= 1e-12);
  const double energy = 0.5 * impact.impulse.dot(before + impact.velocity);
  CHECK(std::abs(energy + 0.785709093289) <= 1e-12);
}

TEST_CASE("routh 11: a ball slides, or rolls away; without friction Newton", "[routh][reference]") {
  const Matrix3 W = felt({0.0, -0.25, 0.0}, Vector3::Constant(0.4 * 0.0625), floor_axes());
  const Vector3 before(-4.0, 3.0, 0.0);
  const auto slides = routh_impact(W, before, 0.1, 0.8);
  CHECK(std::abs(3.0 + slides.impulse[1] - 2.28) <= 1e-15);
  const auto rolls = routh_impact(W, before, 0.3, 0.8);
  CHECK(std::abs(3.0 + rolls.impulse[1] - 15.0 / 7.0) <= 1e-15);
  CHECK(rolls.velocity[1] == 0.0);
  const auto rough = routh_impact(W, before, INFINITY, 0.8);
  CHECK(std::abs(rough.impulse[1] - rolls.impulse[1]) <= 1e-15);
  for (const double e : {0.0, 0.3, 1.0}) {
    const auto smooth = routh_impact(W, before, 0.0, e);
    CHECK(std::abs(smooth.velocity[0] - 4.0 * e) <= 4e-15);
    CHECK(smooth.impulse.tail<2>().isZero(0.0));
  }
}

TEST_CASE("routh: restitution is Stronge's, friction never gains, impulses stay in their cone",
          "[routh]") {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    CAPTURE(seed);
    Random random(2026, seed);
    const auto pick = [&](double low, double high) { return random.uniform(low, high); };
    const Vector3 arm(pick(-1, 1), pick(-1, 0), pick(-1, 1));
    const Matrix3 W = felt(arm, {pick(0.05, 1), pick(0.05, 1), pick(0.05, 1)}, floor_axes());
    const Vector3 before(-pick(0.1, 2), pick(-2, 2), seed % 3 == 0 ? 0.0 : pick(-2, 2));
    const double mu = seed % 7 == 0 ? INFINITY : pick(0.0, 0.6);
    const double e = pick(0.0, 1.0);
    const RouthImpact impact = routh_impact(W, before, mu, e);
    if (!impact.solved) {
      CHECK(impact.jammed);  // only where pressing does not part them
      continue;
    }
    CHECK(impact.velocity[0] >= 0.0);
    CHECK((impact.velocity - before - W * impact.impulse).norm() <= 1e-11);
    const double gained = 0.5 * impact.impulse.dot(before + impact.velocity);
    CHECK(gained <= 1e-12);
    CHECK(impact.friction_work <= 1e-14);
    CHECK(impact.normal_work <= 1e-14);
    CHECK(std::abs(impact.normal_work + impact.friction_work - gained) <= 1e-12);
    if (std::isfinite(mu)) {
      CHECK(impact.impulse.tail<2>().norm() <= mu * impact.impulse[0] * (1.0 + 1e-12) + 1e-15);
    }
  }
}

TEST_CASE("routh: sliding that turns, against many small impulses", "[routh]") {
  const Matrix3 W = felt({0.4, -0.5, 0.3}, {0.2, 0.3, 0.1}, floor_axes());
  const Vector3 before(-1.0, 0.8, 1.1);
  const double mu = 0.2;
  const RouthImpact impact = routh_impact(W, before, mu, 0.0);
  REQUIRE(impact.solved);
  // The midpoint rule in the normal impulse, up to where the approach ends.
  const auto at_end = [&](int steps) {
    const auto rate = [&](const Vector3& u) {
      const Eigen::Vector2d d = u.tail<2>().normalized();
      return Vector3(W * Vector3(1.0, -mu * d[0], -mu * d[1]));
    };
    Vector3 u = before;
    const double h = impact.impulse[0] / steps;
    for (int k = 0; k < steps; ++k) {
      u += h * rate(u + 0.5 * h * rate(u));
    }
    return u;
  };
  const double coarse = (at_end(1000) - impact.velocity).norm();
  const double fine = (at_end(2000) - impact.velocity).norm();
  CHECK(fine <= 1e-6);
  CHECK(coarse / fine == Approx(4.0).epsilon(0.05));  // of order 2, to the same limit
}

// Powers of two in masses and speeds scale impulses, to the last bit, and friction may be as large
// as it likes: no coefficient of a series overflows or vanishes.
TEST_CASE("routh: sliding that turns, of what is light or heavy, smooth or rough", "[routh]") {
  constexpr std::uint64_t seed = 20261130;
  CAPTURE(seed);
  Random random(seed);
  for (int trial = 0; trial < 100; ++trial) {
    Matrix3 levers;
    for (int k = 0; k < 3; ++k) {
      levers.col(k) = random.direction();
    }
    const Matrix3 W = Matrix3::Identity() + levers.transpose() * levers;
    Vector3 u = random.direction();
    u[0] = -std::abs(u[0]);
    const double e = random.uniform();
    for (const double mu : {1e-30, 0.5, 1e6, 1e12, 1e30}) {
      CAPTURE(trial, mu);
      const RouthImpact one = routh_impact(W, u, mu, e);
      REQUIRE(one.solved);
      CHECK(one.impulse.allFinite());
      for (const auto& [light, fast] : {std::pair{120, -40}, {-120, 40}, {100, 60}}) {
        const double f = std::ldexp(1.0, light);
        const double v = std::ldexp(1.0, fast);
        const RouthImpact other = routh_impact(f * W, v * u, mu, e);
        CHECK(other.solved);
        CHECK(other.impulse == Vector3(v / f * one.impulse));
        CHECK(other.velocity == Vector3(v * one.velocity));
      }
    }
  }
}

// A cube that falls flat onto a face while a corner of it rests: what holds the corner that strikes
// is just the friction that there is, if that is 0.6. Whether it slides or sticks is roundoff, and
// how it moves afterwards is not.
TEST_CASE("routh: friction that just holds", "[routh]") {
  const double inertia = 0.08 / 12.0;
  const Vector3 axes[3] = {Vector3::UnitY(), Vector3::UnitX(), Vector3::UnitZ()};
  for (const double aside : {0.0, 2e-10, 1e-9, 1e-8}) {
    for (const double lower : {0.0, 2.7e-11}) {
      for (const double slip : {0.0, 1e-16, 1e-11, 2e-10, -4e-5}) {
        for (const double e : {0.0, 0.5}) {
          CAPTURE(aside, lower, slip, e);
          const Vector3 arm(0.1, -0.1 - lower, aside);
          Matrix3 W;
          for (int i = 0; i < 3; ++i) {
            for (int k = 0; k < 3; ++k) {
              W(i, k) = axes[i].dot(axes[k]) +
                        axes[i].dot(Vector3(arm.cross(axes[k]) / inertia).cross(arm));
            }
          }
          const Vector3 before(-1.5, slip, -4.1e-11);
          const RouthImpact impact = routh_impact(W, before, 0.6, e);
          REQUIRE(impact.solved);
          // Sticking, W_nn - W_nt^2 / W_tt = 1.6 is what it feels.
          CHECK(impact.impulse[0] == Approx((1.0 + e) * 1.5 / 1.6).epsilon(1e-4));
          CHECK(impact.velocity.tail<2>().norm() <= std::abs(slip) + 5e-11);
          CHECK((impact.velocity - before - W * impact.impulse).norm() <= 1e-12);
          CHECK(impact.friction_work <= 0.0);
          CHECK(impact.impulse.tail<2>().norm() <= 0.6 * impact.impulse[0] * (1.0 + 1e-11));
        }
      }
    }
  }
}

TEST_CASE("routh: a point that joints let move along one line", "[routh]") {
  // Pressed together it feels the normal impulse and friction that helps, let go friction that does
  // not. Where friction is more than the line is steep it is not let go.
  for (const double steep : {0.3, 0.8, 2.0}) {
    const Vector3 line = Vector3(steep, -1.0, 0.0).normalized();
    const Matrix3 W = 2.0 * line * line.transpose();
    for (const double mu : {0.0, 0.25, 0.5, 3.0, static_cast<double>(INFINITY)}) {
      for (const double e : {0.0, 0.6, 1.0}) {
        CAPTURE(steep, mu, e);
        const Vector3 before = -1.5 * line;
        const RouthImpact impact = routh_impact(W, before, mu, e);
        REQUIRE(impact.solved);
        const double share = std::isinf(mu) ? 0.0 : (steep - mu) / (steep + mu);
        const double after = share > 0.0 ? 1.5 * e * std::sqrt(share) : 0.0;
        CHECK((impact.velocity - after * line).norm() <= 1e-14);
        const double gained = 0.5 * impact.impulse.dot(before + impact.velocity);
        CHECK(std::abs(impact.normal_work + impact.friction_work - gained) <= 1e-14);
        CHECK(impact.friction_work <= 0.0);
      }
    }
  }
}

TEST_CASE("routh: what joints let not slide is rubbed all the same", "[routh]") {
  // Along the second tangent nothing moves but by itself: the surface runs on underneath.
  Matrix3 W = Matrix3::Zero();
  W(0, 0) = 1.0;
  W(1, 1) = 2.0;
  W(0, 1) = W(1, 0) = 0.3;
  const double mu = 0.4;
  for (const double across : {0.2, 5.0, 1e-9}) {
    CAPTURE(across);
    const Vector3 before(-1.0, 0.7, across);
    const RouthImpact impact = routh_impact(W, before, mu, 0.5);
    REQUIRE(impact.solved);
    CHECK(impact.velocity[2] == across);
    CHECK(impact.velocity[0] > 0.0);
    CHECK(impact.impulse.tail<2>().norm() <= mu * impact.impulse[0] * (1.0 + 1e-12));
    CHECK((impact.velocity - before - W * impact.impulse).norm() <= 1e-12);
    const double gained = 0.5 * impact.impulse.dot(before + impact.velocity);
    CHECK(std::abs(impact.normal_work + impact.friction_work - gained) <= 1e-11);
  }
  // Nothing else slides: friction acts along that, and changes nothing.
  W(1, 1) = W(0, 1) = W(1, 0) = 0.0;
  const RouthImpact along = routh_impact(W, {-1.0, 0.0, 2.0}, mu, 0.5);
  REQUIRE(along.solved);
  CHECK((along.impulse - Vector3(1.5, 0.0, -1.5 * mu)).norm() <= 1e-14);
  CHECK(along.friction_work == Approx(-1.5 * mu * 2.0));
  // Without a bound nothing goes with it.
  CHECK_FALSE(routh_impact(W, {-1.0, 0.0, 2.0}, INFINITY, 0.5).solved);
}

TEST_CASE("routh: what joints and friction lock stands still", "[routh]") {
  // Along one line only do joints let the point move: any pressing that friction holds across is
  // taken up, and all motion ends at once. Two balls that hang side by side are such a case.
  for (const double angle : {0.3, 0.0063, 3e-5, -0.4}) {
    const Vector3 line = Vector3(std::cos(angle), std::sin(angle), 0.0);
    const Matrix3 W = 2.0 * line * line.transpose();
    for (const double speed : {1.3, 1e-4, 3e-12}) {
      // The velocities of the two, of which this is a difference, have roundoff of their own.
      const Vector3 before = -speed * line + Vector3(0.0, 2e-16, 0.0);
      const RouthImpact impact = routh_impact(W, before, INFINITY, 0.5, 1.0);
      CAPTURE(angle, speed);
      REQUIRE(impact.solved);
      CHECK(impact.velocity.norm() <= 1e-12 * speed + 1e-15);
      CHECK(impact.impulse[0] > 0.0);
      CHECK(impact.friction_work <= 0.0);
      CHECK(impact.normal_work + impact.friction_work ==
            Approx(-0.25 * speed * speed).epsilon(1e-3 * 3e-12 / speed + 1e-12));
    }
  }
  // What a drive moves across it cannot be stopped.
  const Vector3 steep(0.1, std::sqrt(0.99), 0.0);
  const Matrix3 W = 2.0 * steep * steep.transpose();
  CHECK_FALSE(routh_impact(W, -steep + Vector3(-0.1, 0.01, 0.0), INFINITY, 0.5, 1.0).solved);
}

TEST_CASE("routh 13: Painleve's angles of a rod and of a thin box", "[routh][reference]") {
  // A rod of length 2 slides on its end at the angle theta: the sign of W_nn - mu W_nt.d changes.
  const auto edge = [](double half, double thick, double mu, double from, double to) {
    const auto paradox = [&](double theta) {
      // Sliding towards where the rod leans from: the corner that is lowest.
      return painleve(on_corner(half, thick, theta), mu, {1.0, 0.0}) ||
             painleve(on_corner(half, thick, theta), mu, {-1.0, 0.0});
    };
    REQUIRE(paradox(from) != paradox(to));
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (from + to);
      (paradox(middle) == paradox(from) ? from : to) = middle;
    }
    return from;
  };
  CHECK(std::abs(edge(0.5, 0.0, 1.5, 0.5, 1.1) - 0.883862626373) <= 1e-11);
  CHECK(std::abs(edge(0.5, 0.0, 1.5, 1.1, 1.5) - 1.27493630397) <= 1e-11);
  CHECK(std::abs(edge(0.5, 0.01, 1.5, 0.5, 1.1) - 0.863865292400) <= 1e-11);
  CHECK(std::abs(edge(0.5, 0.01, 1.5, 1.1, 1.5) - 1.25493897000) <= 1e-11);
  // Of a thin rod none below mu = 4/3.
  for (double theta = 0.0; theta < 1.57; theta += 1e-3) {
    CHECK_FALSE(painleve(on_corner(0.5, 0.0, theta), 4.0 / 3.0 - 1e-9, {1.0, 0.0}));
    CHECK_FALSE(painleve(on_corner(0.5, 0.0, theta), 4.0 / 3.0 - 1e-9, {-1.0, 0.0}));
  }
}
