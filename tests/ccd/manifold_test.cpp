// The points of a patch: where two shapes touch, in whatever frame.

#include "ccd/certified.hpp"
#include "core/polytope.hpp"
#include "core/random.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

using namespace kairos;

namespace {

struct Placed {
  Shape shape;
  Pose pose;
};

Pose at(const Vector3& p, const Vector3& turn = Vector3::Zero()) {
  return {p, rotate(turn, Quaternion::Identity())};
}

/// Asked both ways round: the same points, the normal reversed.
ContactManifold ask(const Placed& a, const Placed& b, double reach) {
  const auto detector = ccd::make_certified();
  const ContactManifold m = detector->manifold(a.shape, a.pose, b.shape, b.pose, reach);
  const ContactManifold r = detector->manifold(b.shape, b.pose, a.shape, a.pose, reach);
  CHECK(m.size == r.size);
  CHECK((m.normal + r.normal).norm() <= 1e-15);
  return m;
}

}  // namespace

TEST_CASE("a box on a floor touches at its lowest vertices", "[manifold]") {
  const Placed floor{HalfSpace{}, at(Vector3::Zero())};
  const Placed box{Box{{0.5, 0.25, 1.0}}, at({1.0, 0.25, -2.0})};
  const ContactManifold flat = ask(box, floor, 1e-9);
  REQUIRE(flat.size == 4);
  CHECK(flat.face_of_a);
  CHECK(flat.face_of_b);
  CHECK(flat.normal == -Vector3::UnitY());
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(std::abs(std::abs(flat.points[k].position.x() - 1.0) - 0.5) <= 1e-15);
    CHECK(flat.points[k].gap == 0.0);
  }
  // Turned about z by 0.1: an edge of two vertices, lower than the other by 2 hx sin 0.1.
  const Placed tilted{Box{{0.5, 0.25, 1.0}}, at({0.0, 1.0, 0.0}, {0.0, 0.0, 0.1})};
  const double low = 1.0 - 0.5 * std::sin(0.1) - 0.25 * std::cos(0.1);
  CHECK(ask(tilted, floor, low - 1e-12).size == 0);
  CHECK(ask(tilted, floor, low + 1e-12).size == 2);
  CHECK(ask(tilted, floor, low + std::sin(0.1) + 1e-12).size == 4);
}

TEST_CASE("two boxes share the corners of the common part of their faces", "[manifold]") {
  const Placed lower{Box{{0.5, 0.5, 0.5}}, at(Vector3::Zero())};
  const Placed aligned{Box{{0.5, 0.5, 0.5}}, at({0.25, 1.0, 0.0})};
  const ContactManifold half = ask(lower, aligned, 1e-9);
  REQUIRE(half.size == 4);
  CHECK(half.normal == Vector3::UnitY());
  for (std::size_t k = 0; k < half.size; ++k) {
    const Vector3& p = half.points[k].position;
    CHECK((std::abs(p.x() + 0.25) <= 1e-15 || std::abs(p.x() - 0.5) <= 1e-15));
    CHECK(std::abs(std::abs(p.z()) - 0.5) <= 1e-15);
  }
  // Turned by 45 degrees an octagon is left.
  const Placed turned{Box{{0.5, 0.5, 0.5}}, at({0.0, 1.0, 0.0}, {0.0, M_PI / 4.0, 0.0})};
  CHECK(ask(lower, turned, 1e-9).size == 8);
  // Beside each other: nothing, however near the planes of their faces are.
  const Placed beside{Box{{0.5, 0.5, 0.5}}, at({1.1, 1.0, 0.0})};
  CHECK(ask(lower, beside, 1e-9).size == 0);
}

TEST_CASE("crossed edges touch in one point, which belongs to no face", "[manifold]") {
  const double r = std::sqrt(0.5);
  const Placed lower{Box{{0.5, 0.5, 2.0}}, at(Vector3::Zero(), {0.0, 0.0, M_PI / 4.0})};
  const Placed upper{Box{{2.0, 0.5, 0.5}}, at({0.3, 2.0 * r, 0.4}, {M_PI / 4.0, 0.0, 0.0})};
  const ContactManifold m = ask(lower, upper, 1e-9);
  REQUIRE(m.size == 1);
  CHECK_FALSE(m.face_of_a);
  CHECK_FALSE(m.face_of_b);
  CHECK((m.points[0].position - Vector3(0.0, r, 0.4)).norm() <= 1e-14);
  CHECK((m.normal - Vector3::UnitY()).norm() <= 1e-14);
}

TEST_CASE("a ball has one point", "[manifold]") {
  const Placed ball{Sphere{0.5}, at({0.0, 1.0, 0.0})};
  const Placed box{Box{{0.5, 0.5, 0.5}}, at(Vector3::Zero())};
  const ContactManifold on_face = ask(ball, box, 1e-9);
  REQUIRE(on_face.size == 1);
  CHECK(on_face.face_of_b);
  CHECK((on_face.points[0].position - Vector3(0.0, 0.5, 0.0)).norm() <= 1e-15);
  const Placed at_edge{Sphere{0.5}, at({0.5 + 0.3, 0.5 + 0.4, 0.0})};
  const ContactManifold on_edge = ask(at_edge, box, 1e-9);
  REQUIRE(on_edge.size == 1);
  CHECK_FALSE(on_edge.face_of_b);
}

TEST_CASE("points turn with the world", "[manifold][invariance]") {
  Random random{7};
  for (int trial = 0; trial < 200; ++trial) {
    CAPTURE(trial);
    const Vector3 turn(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0),
                       random.uniform(-3.0, 3.0));
    const Placed a{Box{{0.5, 0.4, 0.3}}, at(Vector3::Zero())};
    const Placed b{Box{{0.2, 0.3, 0.4}},
                   at({random.uniform(-0.6, 0.6), 0.7, random.uniform(-0.6, 0.6)},
                      {0.0, random.uniform(-3.0, 3.0), 0.0})};
    const auto turned = [&](const Placed& p) {
      const Quaternion q = rotate(turn, Quaternion::Identity());
      return Placed{p.shape, {q * p.pose.position, q * p.pose.orientation}};
    };
    const ContactManifold m = ask(a, b, 1e-9);
    const ContactManifold n = ask(turned(a), turned(b), 1e-9);
    REQUIRE(m.size == n.size);
    Vector3 sum = Vector3::Zero();
    for (std::size_t k = 0; k < m.size; ++k) {
      sum += rotate(turn, Quaternion::Identity()) * m.points[k].position - n.points[k].position;
    }
    CHECK(sum.norm() <= 1e-13);  // roundoff of two rotations of eight points
  }
}

TEST_CASE("boxes that lie on each other with a small tilt touch in a face, not where edges cross",
          "[manifold]") {
  const Placed lower{Box{{0.25, 0.25, 0.25}}, at(Vector3::Zero())};
  int faces = 0;
  Random random(20261122);
  INFO("seed 20261122");
  for (int trial = 0; trial < 200; ++trial) {
    // About horizontal axes, by up to 2e-3, with a corner up to 1 mm deep.
    const double angle = random.uniform(0.0, 2.0 * M_PI);
    const Vector3 tilt = random.uniform(0.0, 2e-3) * Vector3(std::cos(angle), 0.0, std::sin(angle));
    const Placed upper{Box{{0.25, 0.25, 0.25}}, at({1e-3, 0.4995, -2e-3}, tilt)};
    const ContactManifold m = ask(lower, upper, 2e-3);
    faces += m.face_of_a || m.face_of_b ? 1 : 0;
    CHECK(m.size >= 4);
  }
  CHECK(faces == 200);
}

// The edge lies on the face of the first or of the second: its ends are found either way.
TEST_CASE("an edge on a face touches with both its ends, whatever shapes they are of",
          "[manifold]") {
  std::vector<Vector3> corners;
  for (int k = 0; k < 8; ++k) {
    corners.emplace_back((k & 1) != 0 ? 1.0 : -1.0, (k & 2) != 0 ? 0.5 : -0.5,
                         (k & 4) != 0 ? 2.0 : -2.0);
  }
  const Hull block = Hull{convex_hull(corners).polytope};
  const std::vector<Placed> floors{{Box{{1.0, 0.5, 2.0}}, at(Vector3::Zero())},
                                   {block, at(Vector3::Zero())}};
  // Each has an edge of length 1 along z above (0.25, 0.5, 0.5).
  const Vector3 middle(0.25, 0.5, 0.5);
  const Pose on_edge = at(middle + Vector3(0.0, std::sqrt(0.5), 0.0), {0.0, 0.0, M_PI / 4.0});
  for (Vector3& x : corners) {
    x = x.cwiseProduct(Vector3(0.5, 1.0, 0.25));
  }
  const std::vector<Placed> edges{
      {Box{{0.5, 0.5, 0.5}}, on_edge},
      {Hull{convex_hull(corners).polytope}, on_edge},
      {Capsule{0.1, 1.0}, at(middle + Vector3(0.0, 0.1, 0.0), {M_PI / 2.0, 0.0, 0.0})},
      {Cylinder{0.1, 1.0}, at(middle + Vector3(0.0, 0.1, 0.0), {M_PI / 2.0, 0.0, 0.0})}};
  for (const Placed& floor : floors) {
    for (const Placed& edge : edges) {
      CAPTURE(floor.shape.index(), edge.shape.index());
      const ContactManifold m = ask(floor, edge, 1e-9);
      REQUIRE(m.size == 2);
      CHECK((m.normal - Vector3::UnitY()).norm() <= 1e-12);
      std::array<double, 2> along{m.points[0].position.z(), m.points[1].position.z()};
      std::sort(along.begin(), along.end());
      CHECK(along[0] == Approx(0.0).margin(1e-9));
      CHECK(along[1] == Approx(1.0).margin(1e-9));
      for (std::size_t k = 0; k < m.size; ++k) {
        CHECK(std::abs(m.points[k].position.x() - 0.25) <= 1e-9);
      }
    }
  }
}

// Reported as inside each other by a tenth of their size where they share less than roundoff.
TEST_CASE("what is inside another by roundoff is not deep inside", "[manifold]") {
  const auto detector = ccd::make_certified();
  const Box floor{{1.0, 0.1, 1.0}};
  const Cone cone{0.15, 0.3};
  for (const double sunk : {0.0, 3e-17, 1e-16, 1e-15, 1e-13, 1e-9}) {
    const Pose pose = at({0.0, 0.225 - sunk, 0.0}, {0.0, 0.0, M_PI});
    CAPTURE(sunk);
    const Overlap found = detector->overlap(floor, at({0.0, -0.1, 0.0}), cone, pose);
    CHECK(std::abs(found.gap + sunk) <= 1e-15);  // 4 eps of the coordinates
  }
}
