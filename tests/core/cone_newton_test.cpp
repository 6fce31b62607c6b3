// Impulses at many touches at once, against the conditions that define them.

#include "core/contacts/cone_newton.hpp"

#include "core/contacts/body_system.hpp"
#include "core/contacts/cone_interior.hpp"
#include "core/contacts/contact_sweeps.hpp"
#include "core/contacts/contact_system.hpp"
#include "core/random.hpp"
#include "tests/catch.hpp"

#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

using namespace kairos;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using Vector6 = ContactSweeps::Vector6;

/// A ball of this mass and radius 1, or what nothing moves.
GroupBody ball(double mass, const Vector3& position) {
  GroupBody body;
  body.inverse_mass = std::isinf(mass) ? 0.0 : 1.0 / mass;
  body.inverse_inertia = 2.5 * body.inverse_mass * Matrix3::Identity();
  body.position = position;
  return body;
}

SweptTouch touch(const std::vector<GroupBody>& bodies, std::size_t a, std::size_t b,
                 double friction) {
  const Vector3 apart = bodies[b].position - bodies[a].position;
  const Vector3 point = bodies[a].position + 0.5 * apart;
  return {a, b, apart.normalized(), point, point, friction};
}

/// Signorini's and Coulomb's law at each touch.
bool keeps_the_law(const ConeProblem& problem, const Eigen::VectorXd& p, double tolerance) {
  const Eigen::VectorXd u = problem.W * p + problem.q;
  bool keeps = true;
  for (Eigen::Index k = 0; 3 * k < p.size(); ++k) {
    const Eigen::Vector3d pk = p.segment<3>(3 * k), uk = u.segment<3>(3 * k);
    const double mu = problem.friction[static_cast<std::size_t>(k)];
    const double pushed = pk.tail<2>().norm(), slip = uk.tail<2>().norm();
    keeps = keeps && pk[0] >= -tolerance && uk[0] >= -tolerance &&
            std::abs(pk[0] * uk[0]) <= tolerance &&
            (std::isinf(mu) ? pk[0] * slip <= tolerance
                            : pushed <= mu * pk[0] + tolerance &&
                                  pk.tail<2>().dot(uk.tail<2>()) <=
                                      -mu * std::max(pk[0], 0.0) * slip + tolerance);
  }
  return keeps;
}

/// A wall of cubes of 1 m on a floor, each of which touches its neighbours and what is below it at
/// four corners: 24 numbers of a row say what six suffice for. Each cube moves at random.
ConeProblem wall(int wide, int high, Random& random) {
  const auto cubes = static_cast<std::size_t>(wide * high);
  ContactSystem system;
  for (std::size_t i = 0; i < cubes; ++i) {
    const double mass = std::pow(10.0, random.uniform(-1.5, 1.5));
    GroupBody body;
    body.inverse_mass = 1.0 / mass;
    body.inverse_inertia = 6.0 / mass * Matrix3::Identity();
    body.position = {static_cast<double>(i % static_cast<std::size_t>(wide)),
                     static_cast<double>(i / static_cast<std::size_t>(wide)), 0.0};
    system.bodies.push_back(body);
  }
  system.bodies.emplace_back();  // the floor
  ConeProblem problem;
  const auto face = [&](std::size_t a, std::size_t b, const Vector3& middle, const Vector3& n) {
    const double mu = random.uniform(0.0, 1.0);
    const Vector3 t = n.unitOrthogonal();
    const Vector3 s = n.cross(t);
    for (const auto& [x, y] : {std::pair{-0.5, -0.5}, {-0.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}}) {
      problem.friction.push_back(mu);
      ConeRoot root{a, b};
      Eigen::Index r = 0;
      for (const Vector3& d : {n, t, s}) {
        const Vector3 at = middle + x * t + y * s;
        system.add(a, b, at, d);
        for (const auto& [i, sign, of] : {std::tuple{a, -1.0, &root.of_a}, {b, 1.0, &root.of_b}}) {
          const GroupBody& body = system.bodies[i];
          of->row(r).head<3>() = sign * std::sqrt(body.inverse_mass) * d;
          of->row(r).tail<3>() =
              sign * std::sqrt(body.inverse_inertia(0, 0)) * (at - body.position).cross(d);
        }
        ++r;
      }
      problem.roots.push_back(root);
    }
  };
  for (std::size_t i = 0; i < cubes; ++i) {
    const Vector3& at = system.bodies[i].position;
    const bool first = at.x() == 0.0, lowest = at.y() == 0.0;
    face(lowest ? cubes : i - static_cast<std::size_t>(wide), i, at - 0.5 * Vector3::UnitY(),
         Vector3::UnitY());
    if (!first) {
      face(i - 1, i, at - 0.5 * Vector3::UnitX(), Vector3::UnitX());
    }
  }
  std::vector<Twist> v(cubes + 1);
  for (std::size_t i = 0; i < cubes; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      v[i].linear[axis] = random.uniform(-1.0, 1.0);
      v[i].angular[axis] = random.uniform(-1.0, 1.0);
    }
  }
  problem.W = system.coupling();
  problem.q = system.rates(v);
  return problem;
}

/// One to six touches, coupled at random; in every other trial of fewer bodies than touches, so
/// that impulses are redundant.
ConeProblem couplings(int trial, Random& random) {
  const Eigen::Index touches = 1 + trial % 6;
  const Eigen::Index rows = 3 * touches;
  const Eigen::Index freedom = trial % 2 == 0 ? rows : 6 * (1 + touches / 3);
  Eigen::MatrixXd J(rows, freedom);
  Eigen::VectorXd motion(freedom);
  for (Eigen::Index i = 0; i < freedom; ++i) {
    motion[i] = random.uniform(-1.0, 1.0);
    for (Eigen::Index j = 0; j < rows; ++j) {
      J(j, i) = random.uniform(-1.0, 1.0);
    }
  }
  return {J * J.transpose(), J * motion, std::vector<double>(static_cast<std::size_t>(touches))};
}

Vector6 falling(double speed) { return (Vector6() << 0.0, -speed, 0.0, 0.0, 0.0, 0.0).finished(); }

}  // namespace

TEST_CASE("Newton's method on cones finds impulses that satisfy Coulomb's law, with few exceptions",
          "[friction]") {
  Random random(20261126);
  int found = 0;
  constexpr int trials = 2'000;
  for (int trial = 0; trial < trials; ++trial) {
    ConeProblem problem = couplings(trial, random);
    for (std::size_t k = 0; k < problem.friction.size(); ++k) {
      const double mu = random.uniform(0.0, 1.0);
      problem.friction[k] = k % 5 == 4 ? infinity : k % 5 == 3 ? 0.0 : mu;
    }
    constexpr double settled = 1e-12;  // of velocities near 1
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(problem.q.size());
    const Eigen::VectorXd p = cone_newton(problem, none, settled).impulse;
    // What is off in a touch is measured in velocities, and felt by compliances up to 30.
    found += keeps_the_law(problem, p, 1e-10 * (1.0 + p.norm())) ? 1 : 0;
  }
  CAPTURE(found);
  // It may go round in a circle, and tells its best then: 21 times of 2,000 here.
  CHECK(found >= trials - 40);
}

TEST_CASE("Newton's method finds the impulse that jams Painleve's rod, however fast it slides",
          "[friction]") {
  // A rod of 1 kg and 2 m that leans by this angle and slides towards where it leans: where
  // friction presses the more the more it presses, the impulse that stops it is the only one.
  for (const double angle : {50.0, 60.0, 70.0}) {
    for (const double mu : {2.0, 3.0}) {
      for (const double speed : {0.01, 1.0, 100.0, 1e4}) {
        CAPTURE(angle, mu, speed);
        const double c = std::cos(angle * M_PI / 180.0);
        const double s = std::sin(angle * M_PI / 180.0);
        ConeProblem rod{Eigen::Matrix3d::Identity(), Eigen::Vector3d(-0.01, speed, 0.0), {mu}};
        rod.W.topLeftCorner<2, 2>() << 1.0 + 3.0 * c * c, 3.0 * s * c, 3.0 * s * c,
            1.0 + 3.0 * s * s;
        REQUIRE(rod.W(0, 0) - mu * rod.W(0, 1) < 0.0);  // Painleve's case
        const ConeImpulses found = cone_newton(rod, Eigen::VectorXd::Zero(3), 1e-12 * speed);
        CHECK(found.off <= 1e-12 * speed);
        const Eigen::VectorXd stops = -rod.W.inverse() * rod.q;
        CHECK((found.impulse - stops).norm() <= 1e-12 * stops.norm());
      }
    }
  }
}

TEST_CASE("proximal points find the impulses of walls, whose touches are redundant", "[friction]") {
  Random random(20261127);
  int newton = 0;
  int proximal = 0;
  constexpr int trials = 40;
  for (int trial = 0; trial < trials; ++trial) {
    const ConeProblem problem = wall(1 + trial % 3, 1 + trial % 4, random);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(problem.q.size());
    constexpr double settled = 1e-12;  // of velocities near 1
    const Eigen::VectorXd p = cone_proximal(problem, none, settled).impulse;
    // Impulses are of masses up to 30.
    proximal += keeps_the_law(problem, p, 1e-10 * (1.0 + p.norm())) ? 1 : 0;
    newton += cone_newton(problem, none, settled).off <= settled ? 1 : 0;
  }
  CAPTURE(newton, proximal);
  CHECK(newton < proximal);
  CHECK(proximal >= trials - 2);
}

TEST_CASE("an interior-point method finds the impulses of walls that Newton's method misses",
          "[friction]") {
  // Up to 16 cubes and 112 touches: 336 rows that say what 96 suffice for.
  Random random(20261129);
  int found = 0;
  int newton = 0;
  constexpr int trials = 32;
  for (int trial = 0; trial < trials; ++trial) {
    const int wide = trial < 30 ? 1 + trial % 3 : 4;
    const ConeProblem problem = wall(wide, wide, random);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(problem.q.size());
    constexpr double settled = 1e-10;  // of velocities near 1: what sweeps of a step settle to
    const ConeImpulses interior = cone_interior(problem, none, settled);
    // Impulses are of masses up to 30. What is told to be off is judged here anew.
    const double near = 1e-8 * (1.0 + interior.impulse.norm());
    found += interior.off <= settled && keeps_the_law(problem, interior.impulse, near) ? 1 : 0;
    newton += trial < 30 && cone_newton(problem, none, settled).off <= settled ? 1 : 0;
  }
  CAPTURE(found, newton);
  // Either may get nowhere, and tells its best then: none here, and 13 times of 30.
  CHECK(newton < found);
  CHECK(found >= trials - 2);
}

TEST_CASE(
    "with a small compliance Newton's method finds the impulses of walls that it misses alone",
    "[friction]") {
  Random random(20261202);
  int compliant = 0;
  int newton = 0;
  constexpr int trials = 40;
  for (int trial = 0; trial < trials; ++trial) {
    const ConeProblem problem = wall(1 + trial % 3, 1 + trial % 4, random);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(problem.q.size());
    constexpr double settled = 1e-10;  // of velocities near 1: what sweeps of a step settle to
    const ConeImpulses found = cone_compliant(problem, none, settled);
    // Impulses are of masses up to 30. What is told to be off is judged here anew.
    const double near = 1e-8 * (1.0 + found.impulse.norm());
    compliant += found.off <= settled && keeps_the_law(problem, found.impulse, near) ? 1 : 0;
    newton += cone_newton(problem, none, settled).off <= settled ? 1 : 0;
  }
  CAPTURE(compliant, newton);
  CHECK(newton < compliant);
  // It may go round in a circle as well: 5 times of 40 here, and 13 times without.
  CHECK(compliant >= trials - 8);
}

TEST_CASE("what touches contradict each other by is left, and they share alike", "[friction]") {
  // A rough cube that falls on its face at 1 m/s. Its corners go apart along the floor by rates
  // that no motion of a rigid body has.
  Random random(20261203);
  for (int trial = 0; trial < 50; ++trial) {
    ConeProblem problem = wall(1, 1, random);
    const double mass = 1.0 / problem.roots[0].of_b.leftCols<3>().row(0).squaredNorm();
    const double contradicted = std::pow(10.0, random.uniform(-9.0, -7.0));
    problem.friction.assign(4, infinity);
    for (Eigen::Index at = 0; at < 12; at += 3) {
      problem.q.segment<3>(at) << -1.0, at % 2 == 0 ? contradicted : -contradicted, 0.0;
    }
    const ConeImpulses found = cone_compliant(problem, Eigen::VectorXd::Zero(12), 1e-10);
    CAPTURE(trial, mass, contradicted, found.impulse, found.off);
    CHECK(found.off >= 0.5 * contradicted);
    CHECK(found.off <= 2.0 * contradicted);
    // The compliance is 1e-7 of what a corner feels, which is that much of a metre a second.
    const double near = 1e-6 * mass;
    for (Eigen::Index at = 0; at < 12; at += 3) {
      CHECK(std::abs(found.impulse[at] - 0.25 * mass) <= near);
      CHECK(found.impulse.segment<2>(at + 1).norm() <= contradicted / 1e-7 * mass + near);
    }
  }
}

TEST_CASE("systems of touches are solved by their bodies as they are as a whole", "[friction]") {
  Random random(20261130);
  for (int trial = 0; trial < 60; ++trial) {
    const ConeProblem problem = wall(1 + trial % 4, 1 + trial % 3, random);
    const auto rows = problem.q.size();
    Eigen::VectorXd unit(rows);
    std::vector<Eigen::Matrix3d> own, inverse, lower;
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(rows, rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      unit[i] = i % 7 == 3 ? 0.0 : random.uniform(0.5, 2.0);
    }
    const Eigen::MatrixXd W = unit.asDiagonal() * problem.W * unit.asDiagonal();
    for (Eigen::Index at = 0; at < rows; at += 3) {
      Eigen::Matrix3d A, L;
      for (Eigen::Index i = 0; i < 9; ++i) {
        A(i / 3, i % 3) = random.uniform(-1.0, 1.0);
      }
      for (Eigen::Index i = 0; i < 9; ++i) {
        L(i / 3, i % 3) = random.uniform(-1.0, 1.0);
      }
      own.emplace_back(A * A.transpose() + 0.1 * Eigen::Matrix3d::Identity());
      inverse.emplace_back(own.back().inverse());
      lower.emplace_back(Eigen::Matrix3d::Identity() + 0.1 * L);
      whole.middleRows<3>(at) = lower.back() * W.middleRows<3>(at);
      whole.block<3, 3>(at, at) += own.back();
    }
    BodySystem bodies(problem.roots, unit);
    bodies.decompose(inverse, lower);
    const Eigen::VectorXd x = bodies.solve(problem.q);
    CAPTURE(trial, rows, bodies.size());
    // D is at least 0.1, and masses are up to 30: conditions up to 1e4 or so.
    CHECK((whole * x - problem.q).norm() <= 1e-11 * whole.norm() * (1.0 + x.norm()));
    // Roundoff of products of 100 and 100.
    const auto again =
        refined(whole, problem.q, 1e-12, [&](const Eigen::VectorXd& b) { return bodies.solve(b); });
    CHECK(again.has_value());
  }
}

TEST_CASE("an interior-point method by bodies finds what it finds as a whole", "[friction]") {
  Random random(20261201);
  int by_bodies = 0;
  int whole = 0;
  for (int trial = 0; trial < 24; ++trial) {
    ConeProblem problem = wall(1 + trial % 3, 1 + trial % 4, random);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(problem.q.size());
    const ConeImpulses found = cone_interior(problem, none, 1e-10);
    by_bodies += found.off <= 1e-10 ? 1 : 0;
    problem.roots.clear();
    const ConeImpulses other = cone_interior(problem, none, 1e-10);
    whole += other.off <= 1e-10 ? 1 : 0;
    if (found.off <= 1e-10 && other.off <= 1e-10) {
      // Impulses may be shared differently; what they do to the rates is the same where friction
      // leaves no choice, and keeps the law either way.
      CHECK(keeps_the_law(problem, found.impulse, 1e-8 * (1.0 + found.impulse.norm())));
    }
  }
  CAPTURE(by_bodies, whole);
  CHECK(by_bodies >= whole - 1);
}

TEST_CASE("among redundant touches an interior-point method shares alike", "[friction]") {
  // A cube that falls flat on its face, and slides: what mirrors it changes nothing.
  Random random(1);
  for (int trial = 0; trial < 20; ++trial) {
    ConeProblem problem = wall(1, 1, random);
    const double mu = random.uniform(0.1, 1.0);
    Eigen::VectorXd fall = Eigen::VectorXd::Zero(12);
    const double slip = trial % 2 == 0 ? 0.0 : random.uniform(0.1, 2.0);
    for (Eigen::Index at = 0; at < 12; at += 3) {
      fall.segment<3>(at) << -1.0, slip, 0.0;
    }
    problem.friction.assign(4, mu);
    problem.q = fall;
    const ConeImpulses found = cone_interior(problem, Eigen::VectorXd::Zero(12), 1e-13);
    CAPTURE(trial, mu, slip, found.impulse, found.off);
    REQUIRE(found.off <= 1e-12);
    // Across the slip two touches push one way as two push the other, hardly: the middle is where
    // they do not at all.
    double across = 0.0;
    for (Eigen::Index at = 0; at < 12; at += 3) {
      across += found.impulse[at + 2];
      CHECK(std::abs(found.impulse[at + 2]) <= 1e-7 * found.impulse.norm());
    }
    CHECK(std::abs(across) <= 1e-10 * found.impulse.norm());
  }
}

TEST_CASE("touches that hold along the surfaces, pressed or not, always have impulses",
          "[friction]") {
  // Of least energy: a quadratic program, convex, and feasible, as standing still is.
  Random random(20261128);
  for (int trial = 0; trial < 400; ++trial) {
    ConeProblem problem = couplings(trial, random);
    for (double& mu : problem.friction) {
      mu = random.uniform(0.0, 1.0) < 0.3 ? 0.0 : infinity;
    }
    problem.friction[0] = infinity;
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(problem.q.size());
    constexpr double settled = 1e-12;  // of velocities near 1
    const Eigen::VectorXd p = cone_at_once(problem, none, settled, AtOnce::held_along).impulse;
    const Eigen::VectorXd u = problem.W * p + problem.q;
    const double near = 1e-10 * (1.0 + p.norm());  // what is off is felt by compliances up to 30
    CAPTURE(trial, p, u);
    for (std::size_t k = 0; k < problem.friction.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(3 * k);
      CHECK(p[at] >= 0.0);
      CHECK(u[at] >= -near);
      CHECK(p[at] * u[at] <= near);
      const bool rough = problem.friction[k] > 0.0;
      CHECK((rough ? u : p).segment<2>(at + 1).norm() <= (rough ? near : 0.0));
    }
  }
}

TEST_CASE("a light ball between heavy ones is settled in few sweeps", "[friction]") {
  // Touch by touch every sweep hands on a part of 1/ratio: a million sweeps.
  constexpr double ratio = 1e6;
  std::vector<GroupBody> bodies{ball(infinity, {0.0, -1.0, 0.0})};
  const std::vector<double> masses{1.0, ratio, 1.0, ratio};
  std::vector<SweptTouch> touches;
  std::vector<Vector6> velocities{Vector6::Zero()};
  for (std::size_t k = 0; k < masses.size(); ++k) {
    bodies.push_back(ball(masses[k], {0.0, 1.0 + 2.0 * static_cast<double>(k), 0.0}));
    touches.push_back(touch(bodies, k, k + 1, 0.3));
    velocities.push_back(falling(1.0));
  }
  const auto swept = ContactSweeps(bodies, touches).sweep(velocities, {}, {}, 1e-13, true);
  // All that lies above comes to rest: the impulse is its momentum. The error is that of settling,
  // of 1e-13 m/s of a body that weighs 1e6.
  double above = 0.0;
  for (std::size_t k = masses.size(); k-- > 0;) {
    above += masses[k];
    CAPTURE(k);
    CHECK((swept.impulse[k] - Vector3(0.0, above, 0.0)).norm() <= 1e-9 * above);
  }
  // Roundoff of an impulse on a heavy ball is felt by a light one.
  for (const Vector6& v : swept.velocities) {
    CHECK(v.norm() <= 4.0 * ratio * std::numeric_limits<double>::epsilon());
  }
  CHECK(swept.solves <= 200 * static_cast<int>(touches.size()));
}
