// How long two boxes that touch are known to part, against where they are at many times: by
// separating axes, in long double.

#include "core/schemes/event/draws_apart.hpp"

#include "core/random.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using namespace kairos;

namespace {

using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;
using Matrix = Eigen::Matrix<Real, 3, 3>;

Vector3 any(Random& random, double size) {
  return size *
         Vector3(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
}

/// The greatest separation along the 15 axes [Gottschalk1996]; negative: they overlap.
Real separation(const Box& a, const Pose& at_a, const Box& b, const Pose& at_b) {
  const Matrix of_a = at_a.orientation.cast<Real>().normalized().toRotationMatrix();
  const Matrix of_b = at_b.orientation.cast<Real>().normalized().toRotationMatrix();
  const Vector way = at_b.position.cast<Real>() - at_a.position.cast<Real>();
  Real greatest = -std::numeric_limits<Real>::infinity();
  const auto along = [&](const Vector& axis) {
    if (axis.norm() < 1e-9L) {
      return;  // parallel edges
    }
    const Vector n = axis.normalized();
    const Real reach = (of_a.transpose() * n).cwiseAbs().dot(a.half_extents.cast<Real>()) +
                       (of_b.transpose() * n).cwiseAbs().dot(b.half_extents.cast<Real>());
    greatest = std::max(greatest, std::abs(n.dot(way)) - reach);
  };
  for (int i = 0; i < 3; ++i) {
    along(of_a.col(i));
    along(of_b.col(i));
    for (int j = 0; j < 3; ++j) {
      along(of_a.col(i).cross(of_b.col(j)));
    }
  }
  return greatest;
}

/// A corner of one box touches a face of another, up to roundoff, and moves off it at this rate.
struct CornerOnFace {
  CornerOnFace(Random& random, double rate) {
    a.half_extents = Vector3::Constant(0.1) + any(random, 1.0).cwiseAbs();
    b.half_extents = Vector3::Constant(0.1) + any(random, 1.0).cwiseAbs();
    at_a = {any(random, 3.0), random.orientation()};
    at_b.orientation = random.orientation();
    const int axis = static_cast<int>(random.below(3));
    Vector3 of_a = Vector3::Unit(axis);
    n = at_a.orientation * of_a;
    Vector3 on_face = any(random, 1.0).cwiseProduct(a.half_extents);
    on_face[axis] = a.half_extents[axis];
    if (random.uniform(0.0, 1.0) < 0.3) {  // at the rim, where edges cross beside it
      const int other = (axis + 1) % 3;
      on_face[other] = a.half_extents[other];
    }
    const Vector3 down = at_b.orientation.conjugate() * -n;
    const Vector3 corner = at_b.orientation * b.half_extents.cwiseProduct(down.cwiseSign().eval());
    const Vector3 point = at_a.to_world(on_face) + random.uniform(-1e-15, 1e-15) * n;
    at_b.position = point - corner;
    Twist of_twist_a{any(random, 1.0), any(random, 5.0)};
    Twist of_twist_b{any(random, 1.0), any(random, 5.0)};
    const double parting =
        n.dot(of_twist_b.at(point, at_b.position) - of_twist_a.at(point, at_a.position));
    of_twist_b.linear += (rate - parting) * n;
    motion_a = Motion::ballistic({}, 1.0, at_a, of_twist_a, any(random, 10.0));
    motion_b = Motion::ballistic({}, 1.0, at_b, of_twist_b, any(random, 10.0));
    rounding = 64.0 * std::numeric_limits<double>::epsilon() *
               (at_a.position.norm() + at_b.position.norm() + a.half_extents.norm() +
                b.half_extents.norm());
  }

  Box a, b;
  Pose at_a, at_b;
  Vector3 n;
  Motion motion_a, motion_b;
  double rounding = 0.0;
};

}  // namespace

TEST_CASE("what draws apart is apart by more than rounding, and never overlaps by more",
          "[draws-apart]") {
  Random random(20261128);
  int found = 0;
  int asked = 0;
  for (int k = 0; k < 2000; ++k) {
    const double rate = std::pow(10.0, random.uniform(-5.0, 0.0));
    const CornerOnFace pair(random, rate);
    const std::array<double, 2> known{
        draws_apart({pair.a, pair.motion_a}, {pair.b, pair.motion_b}, pair.n, {}),
        draws_apart({pair.b, pair.motion_b}, {pair.a, pair.motion_a}, -pair.n, {})};
    CAPTURE(k, rate, known[0], known[1]);
    // 1e-4 m/s: the way of the longest time allowed is some times the rounding that it must exceed.
    asked += rate > 1e-4 ? 1 : 0;
    found += rate > 1e-4 && known[0] > 0.0 ? 1 : 0;
    for (const double d : known) {
      for (int j = 1; d > 0.0 && j <= 50; ++j) {
        const double s = d * j / 50.0;
        const Real apart = separation(pair.a, pair.motion_a.pose(s), pair.b, pair.motion_b.pose(s));
        REQUIRE(apart > -2.0 * pair.rounding);
        REQUIRE((j < 50 || apart > pair.rounding));
      }
    }
  }
  CHECK(found > 0.9 * asked);
}

TEST_CASE("what comes nearer does not draw apart", "[draws-apart]") {
  Random random(20261129);
  for (int k = 0; k < 2000; ++k) {
    const double rate = -std::pow(10.0, random.uniform(-6.0, 0.0));
    const CornerOnFace pair(random, rate);
    CAPTURE(k, rate);
    CHECK(draws_apart({pair.a, pair.motion_a}, {pair.b, pair.motion_b}, pair.n, {}) == 0.0);
  }
}

TEST_CASE("what rests on a half-space that turns is not known to part", "[draws-apart]") {
  const Box box{Vector3(1.0, 1.0, 1.0)};
  const HalfSpace ground{Vector3(0.0, 1.0, 0.0)};
  Pose at;
  at.position = {0.0, 1.0, 0.0};
  const Motion up =
      Motion::ballistic({}, 1.0, at, {Vector3(0.0, 1.0, 0.0), Vector3::Zero()}, Vector3::Zero());
  const Motion still = Motion::ballistic({}, 1.0, Pose(), Twist(), Vector3::Zero());
  const Motion turns = Motion::ballistic({}, 1.0, Pose(), {Vector3::Zero(), Vector3(0.0, 0.0, 1.0)},
                                         Vector3::Zero());
  const Vector3 n = ground.normal_B;
  CHECK(draws_apart({ground, still}, {box, up}, n, {}) > 0.0);
  CHECK(draws_apart({ground, turns}, {box, up}, n, {}) == 0.0);
  CHECK(draws_apart({box, up}, {ground, still}, -n, {}) == 0.0);  // no plane of the box does
}
