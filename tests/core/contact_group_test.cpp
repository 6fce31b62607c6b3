// Groups of bodies in touch without any scheme: who presses, and what impacts do to them.

#include "core/contacts/complementarity.hpp"
#include "core/contacts/flat_modes.hpp"
#include "core/contacts/friction_modes.hpp"
#include "core/contacts/group_impacts.hpp"
#include "core/random.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace kairos;

namespace {

constexpr double g = 9.8;

GroupBody moved_by_impulse(const Vector3& position, double mass, double inertia) {
  return {1.0 / mass, Matrix3::Identity() / inertia, position};
}

/// Four corners of a level face, half a metre from the middle.
ContactManifold level_face(double height, const Vector3& normal, double half = 0.5) {
  ContactManifold m;
  m.normal = normal;
  m.face_of_a = m.face_of_b = true;
  for (const double x : {-half, half}) {
    for (const double z : {-half, half}) {
      m.add({x, height, z}, 0.0);
    }
  }
  return m;
}

/// Place 0 is the ground, 1 to n are cubes of 1 m and 1 kg on each other.
ContactGroup stack(std::size_t n) {
  ContactGroup group;
  for (std::size_t k = 0; k <= n; ++k) {
    const bool ground = k == 0;
    const Vector3 centre(0.0, static_cast<double>(k) - 0.5, 0.0);
    group.bodies.push_back(ground ? GroupBody{0.0, Matrix3::Zero(), centre}
                                  : moved_by_impulse(centre, 1.0, 1.0 / 6.0));
    group.velocities.emplace_back();
    group.loads.push_back({ground ? Vector3(0, 0, 0) : Vector3(0, -g, 0), Vector3::Zero()});
    group.radius.push_back(1.0);
    if (!ground) {
      group.patches.push_back(
          {k - 1, k, level_face(static_cast<double>(k) - 1.0, Vector3::UnitY()), 0.0});
    }
  }
  return group;
}

/// Balls of 1 kg that touch along directions, at rest but for the first.
struct Balls {
  ContactSystem system;
  std::vector<Twist> v;

  void add(const Vector3& position, const Vector3& velocity = Vector3::Zero()) {
    system.bodies.push_back({1.0, Matrix3::Zero(), position});
    v.push_back({velocity, Vector3::Zero()});
  }
  void touch(std::size_t a, std::size_t b) {
    const Vector3 d = (system.bodies[b].position - system.bodies[a].position).normalized();
    system.add(a, b, system.bodies[a].position + d, d);
  }
  [[nodiscard]] double energy() const {
    double sum = 0.0;
    for (const Twist& t : v) {
      sum += 0.5 * t.linear.squaredNorm();
    }
    return sum;
  }
};

Eigen::VectorXd elastic(const Balls& balls, double e = 1.0) {
  return Eigen::VectorXd::Constant(static_cast<Eigen::Index>(balls.system.rows.size()), e);
}

Balls cradle() {
  Balls balls;
  balls.add({0, 0, 0}, {1, 0, 0});
  balls.add({2, 0, 0});
  balls.add({4, 0, 0});
  balls.touch(0, 1);
  balls.touch(1, 2);
  return balls;
}

}  // namespace

TEST_CASE(
    "what turns and slides so slowly that its hops count as rest is at rest, with friction, too",
    "[friction]") {
  Random random(20261127);
  constexpr double rest = 1e-6;
  for (int trial = 0; trial < 200; ++trial) {
    ContactGroup group = stack(2);
    group.round.assign(group.bodies.size(), 0);
    for (GroupPatch& patch : group.patches) {
      patch.friction = random.uniform(0.1, 2.0);
      patch.rest_speed = rest;
    }
    const auto push = [&](Vector3& v, double speed) {
      for (int axis = 0; axis < 3; ++axis) {
        v[axis] = random.uniform(-speed, speed);
      }
    };
    for (const std::size_t i : {1U, 2U}) {  // corners are .87 m from the middle
      push(group.velocities[i].linear, 0.03 * rest);
      push(group.velocities[i].angular, 0.03 * rest);
    }
    const FlatMode still = contact_mode(group, {});
    CAPTURE(trial, still.refusal);
    REQUIRE(still.refusal.empty());
    for (const std::size_t i : {1U, 2U}) {
      CHECK(still.velocities[i].linear.isZero(0.0));
      CHECK(still.velocities[i].angular.isZero(0.0));
      CHECK(still.pressing[i - 1] == Approx(g * static_cast<double>(3 - i)));
      CHECK(still.rate[i - 1] > 0.0);  // it hopped, which the books have to know
    }
    // One that is thrown up turns on.
    group.velocities[2].angular.x() = 4.0 * rest;
    CHECK_FALSE(contact_mode(group, {}).refusal.empty());
  }
}

TEST_CASE("a stack at rest: each patch carries what is above it, in one solve", "[contacts]") {
  for (const std::size_t n : {1U, 10U, 40U}) {
    CAPTURE(n);
    const FlatMode mode = flat_mode(stack(n), {});
    INFO(mode.refusal);
    REQUIRE(mode.refusal.empty());
    CHECK(mode.solves == 1);
    for (std::size_t k = 0; k < n; ++k) {
      const double carried = static_cast<double>(n - k) * g;
      CHECK(mode.kept[k] != 0);
      CHECK(std::abs(mode.pressing[k] - carried) <= 1e-9 * carried);
      CHECK(mode.accelerations[k + 1].linear == Vector3(0, 0, 0));
    }
  }
}

TEST_CASE("a light ball under heavy ones is pressed, and none of them leaves it", "[contacts]") {
  Random random{87493};
  for (int tower = 0; tower < 2000; ++tower) {
    ContactGroup group;
    group.bodies.push_back({0.0, Matrix3::Zero(), Vector3::Zero()});
    group.velocities.emplace_back();
    group.loads.emplace_back();
    group.radius.push_back(0.0);
    double height = 0.0;
    for (std::size_t k = 1; k <= 3; ++k) {
      const double r = random.log_uniform(0.1, 10.0);
      const double mass = k == 1 ? random.log_uniform(1e-4, 1e-2) : random.log_uniform(1.0, 1e3);
      ContactManifold m;
      m.normal = Vector3::UnitY();
      m.face_of_a = m.face_of_b = true;
      m.add({0.0, height, 0.0}, 0.0);
      height += r;
      group.bodies.push_back(moved_by_impulse({0.0, height, 0.0}, mass, 0.4 * mass * r * r));
      height += r;
      group.velocities.emplace_back();
      group.velocities.back().linear.y() = random.uniform(-1e-4, 1e-4);
      group.loads.push_back({Vector3(0, -g, 0), Vector3::Zero()});
      group.radius.push_back(r);
      group.patches.push_back({k - 1, k, m, 3e-4});
    }
    const FlatMode mode = flat_mode(group, {});
    CAPTURE(tower);
    INFO(mode.refusal);
    REQUIRE(mode.refusal.empty());
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(mode.kept[k] != 0);
      // Of the slowest that was projected away, 1e-4 m/s, next to nothing is left.
      CHECK(std::abs(mode.velocities[k + 1].linear.y()) <= 1e-16);
    }
  }
}

TEST_CASE("what hangs over too far begins to turn, and is not kept", "[contacts]") {
  for (const double over : {0.499, 0.501}) {
    ContactGroup group = stack(1);
    group.bodies[1].position.x() += over;
    const FlatMode mode = flat_mode(group, {});
    CHECK(mode.refusal.empty() == (over < 0.5));
  }
}

TEST_CASE("a ball in a level 90 degree groove presses on both sides with m g / sqrt 2",
          "[contacts][reference]") {
  ContactGroup group;
  const double r = std::sqrt(0.5);
  group.bodies = {{0.0, Matrix3::Zero(), {0, 0, 0}},
                  {0.0, Matrix3::Zero(), {0, 0, 0}},
                  {1.0, Matrix3::Zero(), {0, 1, 0}}};
  group.velocities.resize(3);
  group.velocities[2].linear = {0, 0, 3};
  group.loads = {{}, {}, {Vector3(0, -g, 0), Vector3::Zero()}};
  group.radius = {0, 0, 0.5};
  for (const double side : {-1.0, 1.0}) {
    ContactManifold m;
    m.normal = {side * r, r, 0};
    m.face_of_a = true;
    m.add(Vector3(0, 1, 0) - 0.5 * m.normal, 0.0);
    group.patches.push_back({side < 0.0 ? 0U : 1U, 2, m, 0.0});
  }
  const FlatMode mode = flat_mode(group, {});
  INFO(mode.refusal);
  REQUIRE(mode.refusal.empty());
  for (const double force : mode.pressing) {
    CHECK(std::abs(force / g - 0.707106781187) <= 1e-12);
  }
  CHECK(mode.velocities[2].linear == Vector3(0, 0, 3));
}

TEST_CASE("complementarity holds in long double on random groups", "[contacts]") {
  Random random{2026};
  for (int trial = 0; trial < 300; ++trial) {
    CAPTURE(trial);
    const auto n = static_cast<Eigen::Index>(2 + random.bits() % 20);
    const auto dofs = static_cast<Eigen::Index>(1 + random.bits() % 12);  // often redundant rows
    Eigen::MatrixXd J(n, dofs);
    Eigen::VectorXd load(dofs);
    for (double& x : J.reshaped()) {
      x = random.uniform(-1.0, 1.0);
    }
    for (double& x : load) {
      x = random.uniform(-1.0, 1.0);
    }
    const Eigen::MatrixXd W = J * J.transpose();
    const Eigen::VectorXd q = J * load;
    const Complementarity answer = solve_complementarity(W, q);
    REQUIRE(answer.solved);
    using Long = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
    const Long w = W.cast<long double>() * answer.x.cast<long double>() + q.cast<long double>();
    const double scale = std::max(answer.x.maxCoeff(), 1.0) * static_cast<double>(n);
    CHECK(answer.x.minCoeff() >= -1e-10 * scale);
    CHECK(static_cast<double>(w.minCoeff()) >= -1e-9 * scale);
    CHECK(std::abs(static_cast<double>(answer.x.cast<long double>().dot(w))) <= 1e-8 * scale);
  }
}

// Roundoff may leave less than nothing of a matrix that is none: the only row that presses would
// have to pull. Nothing was left to solve for then, and that was a crash.
TEST_CASE("complementarity: where no row can press there is no solution", "[contacts]") {
  Eigen::MatrixXd W(2, 2);
  W << -1e-17, 0.0, 0.0, -2e-17;
  const Complementarity answer = solve_complementarity(W, Eigen::Vector2d(-1.0, -0.5));
  CHECK_FALSE(answer.solved);
  CHECK(answer.x.allFinite());
}

TEST_CASE("a cradle in touch: reflections hand on, moreau shares", "[contacts][reference]") {
  Balls balls = cradle();
  REQUIRE(reflected_group(balls.system, elastic(balls), balls.v).size() == 2);
  CHECK((balls.v[0].linear - Vector3(0, 0, 0)).norm() <= 1e-12);
  CHECK((balls.v[1].linear - Vector3(0, 0, 0)).norm() <= 1e-12);
  CHECK((balls.v[2].linear - Vector3(1, 0, 0)).norm() <= 1e-12);
  balls = cradle();
  REQUIRE(newton_group(balls.system, elastic(balls), balls.v).size() == 2);
  CHECK(std::abs(balls.v[0].linear.x() + 1.0 / 3.0) <= 1e-12);
  CHECK(std::abs(balls.v[1].linear.x() - 2.0 / 3.0) <= 1e-12);
  CHECK(std::abs(balls.v[2].linear.x() - 2.0 / 3.0) <= 1e-12);
}

TEST_CASE("a ball onto two at 30 degrees", "[contacts][reference]") {
  for (const bool reflect : {true, false}) {
    Balls balls;
    balls.add({0, 0, 0}, {1, 0, 0});
    balls.add({std::sqrt(3.0), 1, 0});
    balls.add({std::sqrt(3.0), -1, 0});
    balls.touch(0, 1);
    balls.touch(0, 2);
    (reflect ? reflected_group : newton_group)(balls.system, elastic(balls), balls.v);
    CHECK(std::abs(balls.v[0].linear.x() + 0.2) <= 1e-12);
    CHECK(std::abs(balls.v[1].linear.x() - 0.6) <= 1e-12);
    CHECK(std::abs(balls.v[1].linear.y() - 0.346410161514) <= 1e-12);
    CHECK(std::abs(balls.v[2].linear.y() + 0.346410161514) <= 1e-12);
  }
}

TEST_CASE("impacts of random groups: nothing approaches, momentum is kept, energy as each law says",
          "[contacts]") {
  Random random{77};
  for (int trial = 0; trial < 200; ++trial) {
    CAPTURE(trial);
    Balls balls;
    for (int k = 0; k < 8; ++k) {
      balls.add({random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)},
                {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    }
    for (int k = 0; k < 14; ++k) {
      const auto a = static_cast<std::size_t>(random.bits() % 8);
      const auto b = static_cast<std::size_t>(random.bits() % 8);
      if (a != b) {
        balls.touch(a, b);
        if (balls.system.rate(balls.system.rows.back(), balls.v) > 0.0) {
          balls.system.rows.pop_back();  // laws are asked about what approaches or rests
        }
      }
    }
    if (balls.system.rows.empty()) {
      continue;
    }
    const double e = trial % 2 == 0 ? 1.0 : 0.6;
    for (const bool reflect : {true, false}) {
      Balls after = balls;
      REQUIRE((reflect ? reflected_group : newton_group)(after.system, elastic(after, e), after.v)
                  .size() > 0);
      CHECK(after.system.rates(after.v).minCoeff() >= -1e-9);
      CHECK(after.energy() <= balls.energy() * (1.0 + 1e-12));
      if (reflect && e == 1.0) {
        CHECK(std::abs(after.energy() / balls.energy() - 1.0) <= 1e-10);
      }
      Vector3 momentum = Vector3::Zero();
      for (std::size_t k = 0; k < after.v.size(); ++k) {
        momentum += after.v[k].linear - balls.v[k].linear;
      }
      CHECK(momentum.norm() <= 1e-12);
    }
  }
}
