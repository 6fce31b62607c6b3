// Capsules, cylinders, cones and hulls against what is known exactly: distances, depths, first
// contacts. y is up.

#include "ccd/certified.hpp"
#include "ccd/core_witness.hpp"
#include "ccd/placed_cores.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <numbers>

using namespace kairos;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double g = 9.8;

Shape hull_of(const std::vector<Vector3>& points) { return Hull{convex_hull(points).polytope}; }

std::vector<Vector3> tetrahedron() {  // edge 1, a vertex down
  const double r = std::sqrt(6.0) / 4.0;
  const double low = r / 3.0;
  const double across = std::sqrt(1.0 / 3.0);
  return {
      {0.0, -r, 0.0}, {across, low, 0.0}, {-0.5 * across, low, 0.5}, {-0.5 * across, low, -0.5}};
}

std::vector<Vector3> cube(double half) {
  std::vector<Vector3> points;
  for (int k = 0; k < 8; ++k) {
    points.emplace_back((k & 1) != 0 ? half : -half, (k & 2) != 0 ? half : -half,
                        (k & 4) != 0 ? half : -half);
  }
  return points;
}

Pose at(double x, double y, double z, const Vector3& turn = Vector3::Zero()) {
  return {{x, y, z}, rotate(turn, Quaternion::Identity())};
}

Motion moving(const Pose& pose, const Vector3& v, const Vector3& w = Vector3::Zero(),
              const Vector3& a = Vector3::Zero()) {
  return Motion::ballistic(Instant{}, 1.0, pose, {v, w}, a);
}

/// Asked both ways round; the bracket contains `exact`, itself rounded, and is narrow.
TimeOfImpact check_impact(const Shape& a, const Motion& motion_a, const Shape& b,
                          const Motion& motion_b, double exact) {
  const auto certified = ccd::make_certified();
  const TimeOfImpact toi =
      certified->time_of_impact({a, motion_a}, {b, motion_b}, {Instant{}, 1.0}, 0.0);
  const TimeOfImpact other =
      certified->time_of_impact({b, motion_b}, {a, motion_a}, {Instant{}, 1.0}, 0.0);
  CAPTURE(std::string(to_string(toi.status)), toi.t_lo, toi.t_hi, toi.evaluations, exact);
  CHECK(toi.status == ToiStatus::impact);
  CHECK(other.status == ToiStatus::impact);
  CHECK(toi.t_lo <= exact + 2e-16);
  CHECK(toi.t_hi >= exact - 2e-16);
  CHECK(toi.t_hi - toi.t_lo <= 1e-9);
  CHECK(other.t_lo <= toi.t_hi);
  CHECK(toi.t_lo <= other.t_hi);
  CHECK(toi.evaluations < 100);
  return toi;
}

TimeOfImpact check_floor(const Shape& shape, const Motion& motion, double exact) {
  const Shape floor = HalfSpace{};
  return check_impact(shape, motion, floor, Motion::at_rest(Instant{}, Pose{}), exact);
}

const Vector3 down(0.0, -g, 0.0);

}  // namespace

TEST_CASE("11: a tilted cylinder falls on its rim", "[convex]") {
  const Shape cylinder = Cylinder{0.5, 2.0};
  const TimeOfImpact toi = check_floor(
      cylinder, moving(at(0, 3, 0, {0, 0, pi / 6}), Vector3::Zero(), Vector3::Zero(), down),
      0.6200682313040747);
  CHECK(std::abs(toi.witness_a.y()) <= 1e-8);
}

TEST_CASE("12: a lying cylinder turns until its rim meets the floor", "[convex]") {
  const Shape cylinder = Cylinder{0.5, 2.0};
  check_floor(cylinder, moving(at(0, 1.1, 0, {0, 0, pi / 2}), Vector3::Zero(), {0, 0, 2}),
              0.4636476090008061);
}

TEST_CASE("14: a regular tetrahedron falls on its vertex", "[convex]") {
  const Shape hull = hull_of(tetrahedron());
  CHECK(std::abs(bounding_radius(hull) - std::sqrt(6.0) / 4.0) <= 1e-15);
  check_floor(hull, moving(at(0, 2, 0), Vector3::Zero(), Vector3::Zero(), down),
              0.5321553333732482);
}

TEST_CASE("15, 16: the end of a capsule turns onto a wall and a floor", "[convex]") {
  const Shape arm = Capsule{0.1, 2.0};
  check_floor(arm, moving(at(0, 0.6, 0, {0, 0, pi / 2}), Vector3::Zero(), {0, 0, 2}), pi / 12);
  const Shape dumbbell = Capsule{0.1, 1.0};
  check_floor(dumbbell, moving(at(0, 0.35, 0, {0, 0, pi / 2}), Vector3::Zero(), {0, 0, 3}),
              pi / 18);
}

TEST_CASE("17: a cube turns onto its edge, as a box and as a hull", "[convex]") {
  const Motion motion = moving(at(0, 0.6, 0), Vector3::Zero(), {0, 0, 1});
  const Shape box = Box{Vector3::Constant(0.5)};
  check_floor(box, motion, 0.2277993366979117);
  check_floor(hull_of(cube(0.5)), motion, 0.2277993366979117);
}

TEST_CASE("21: crossed capsules, at rest and closing", "[convex]") {
  const Shape a = Capsule{0.1, 2.0};
  const Shape b = Capsule{0.2, 2.0};
  const Pose pose_b = at(0, 0, 1, {0, 0, pi / 2});
  const ccd::DistanceBounds d = ccd::distance(a, Pose{}, b, pose_b);
  CHECK(d.lower <= 0.7);
  CHECK(d.upper >= 0.7);
  CHECK(d.upper - d.lower <= 1e-13);
  check_impact(a, Motion::at_rest(Instant{}, Pose{}), b, moving(pose_b, {0, 0, -2}), 0.35);
}

TEST_CASE("19: opposite edges of a regular tetrahedron", "[convex]") {
  // As segments: two cores without a radius.
  const ccd::ConvexCore edge = ccd::ConvexCore::segment(0.5, 0.0);
  const Matrix3 R_WA = Matrix3::Identity();
  Matrix3 R_WB;
  R_WB.col(0) = Vector3::UnitY();
  R_WB.col(1) = Vector3::UnitX();
  R_WB.col(2) = -Vector3::UnitZ();
  const Vector3 d(0, 0, std::sqrt(0.5));
  const ccd::CoreWitness w = ccd::core_witness({edge, edge, R_WA, R_WB, d}, 0.0, 1e-15, 1e-15);
  CHECK(std::abs(w.separation - 0.7071067811865476) <= 1e-15);
  // And the solid is as thin across them.
  const auto core = convex_hull(tetrahedron()).polytope;
  const ccd::ConvexCore solid = ccd::ConvexCore::of(*core, 0.0);
  double thinnest = 1.0;
  for (const Vector3& e : core->directions) {
    for (const Vector3& f : core->directions) {
      const Vector3 across = e.cross(f);
      if (across.norm() > 0.9) {  // opposite edges are at right angles
        const Vector3 n = across.normalized();
        thinnest = std::min(thinnest, solid.support(n) + solid.support(-n));
      }
    }
  }
  CHECK(std::abs(thinnest - 0.7071067811865476) <= 1e-15);
}

TEST_CASE("20: an icosahedron's extents and moments", "[convex]") {
  const double phi = 0.5 * (1.0 + std::sqrt(5.0));
  std::vector<Vector3> points;
  for (const double s : {-0.5, 0.5}) {
    for (const double t : {-0.5 * phi, 0.5 * phi}) {
      points.emplace_back(0, s, t);
      points.emplace_back(s, t, 0);
      points.emplace_back(t, 0, s);
    }
  }
  const ConvexHull hull = convex_hull(points);
  const Polytope& p = *hull.polytope;
  CHECK(p.vertices.size() == 12);
  CHECK(p.faces.size() == 20);
  CHECK(p.edges.size() == 30);
  CHECK(std::abs(p.radius - 0.9510565162951536) <= 1e-15);
  for (std::size_t f = 0; f < p.faces.size(); ++f) {
    CHECK(std::abs(p.normals[f].dot(p.vertices[p.faces[f][0]]) - 0.7557613140761708) <= 1e-15);
  }
  const Vector3 moments = solid_inertia(Hull{hull.polytope}, 1.0);
  for (int k = 0; k < 3; ++k) {
    CHECK(std::abs(moments[k] - 0.2618033988749895) <= 1e-14);
  }
}

TEST_CASE("22: unit cubes, .9 apart", "[convex]") {
  const Shape hull = hull_of(cube(0.5));
  const ccd::DepthBounds d = ccd::depth(hull, Pose{}, hull, at(0.9, 0, 0));
  CHECK(d.lower <= 0.1 + 1e-16);
  CHECK(d.upper >= 0.1 - 1e-16);
  CHECK(d.upper - d.lower <= 1e-13);
  CHECK(std::abs(d.normal.x() - 1.0) <= 1e-12);
}

TEST_CASE("a hull forgets what is not a vertex, and refuses what is flat", "[convex]") {
  std::vector<Vector3> points = cube(0.5);
  for (int x = -1; x <= 1; ++x) {  // middles of faces and edges, the centre, all twice
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        points.emplace_back(0.5 * x, 0.5 * y, 0.5 * z);
      }
    }
  }
  const ConvexHull hull = convex_hull(points);
  CHECK(hull.polytope->vertices.size() == 8);
  CHECK(hull.polytope->faces.size() == 6);
  CHECK(hull.polytope->edges.size() == 12);
  CHECK(hull.polytope->axes.vec().isZero(0.0));
  CHECK_THROWS_WITH(convex_hull(std::vector<Vector3>(9, Vector3(1, 2, 3))),
                    Catch::Matchers::Contains("all points are one"));
  CHECK_THROWS_WITH(
      convex_hull(std::vector<Vector3>{{0, 0, 0}, {.1, .1, .1}, {.2, .2, .2}, {.7, .7, .7}}),
      Catch::Matchers::Contains("one line"));
  CHECK_THROWS_WITH(
      convex_hull(std::vector<Vector3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {.3, .2, 0}}),
      Catch::Matchers::Contains("one plane"));
  CHECK_THROWS_WITH(
      convex_hull(std::vector<Vector3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::nan("")}}),
      Catch::Matchers::Contains("not finite"));
}

TEST_CASE("masses of solids of revolution", "[convex]") {
  // A capsule as long as nothing is a ball; as thin as nothing a rod.
  const Vector3 ball = solid_inertia(Capsule{0.5, 1e-12}, 2.0);
  CHECK((ball - Vector3::Constant(0.4 * 2.0 * 0.25)).norm() <= 1e-11);
  const Vector3 rod = solid_inertia(Capsule{1e-9, 3.0}, 2.0);
  CHECK(std::abs(rod.x() - 2.0 * 9.0 / 12.0) <= 1e-8);
  // Cone and cylinder against the hull of many of their points.
  std::vector<Vector3> cone{{0, 1.5, 0}};
  std::vector<Vector3> cylinder;
  for (int k = 0; k < 400; ++k) {
    const double angle = 2.0 * pi * k / 400;
    const Vector3 rim(0.7 * std::cos(angle), 0.0, 0.7 * std::sin(angle));
    cone.push_back(rim - Vector3(0, 0.5, 0));
    cylinder.push_back(rim + Vector3(0, 0.8, 0));
    cylinder.push_back(rim - Vector3(0, 0.8, 0));
  }
  // The area of the polygon is less by 2 (pi / 400)^2 / 3, 4e-5 of it.
  const auto near = [](const Vector3& a, const Vector3& b) {
    return (a - b).norm() <= 2e-4 * b.norm();
  };
  CHECK(near(solid_inertia(hull_of(cone), 1.0), solid_inertia(Cone{0.7, 2.0}, 1.0)));
  CHECK(near(solid_inertia(hull_of(cylinder), 1.0), solid_inertia(Cylinder{0.7, 1.6}, 1.0)));
}

TEST_CASE("contact patches of round things", "[convex]") {
  const auto certified = ccd::make_certified();
  const Shape floor = HalfSpace{};
  const Shape cylinder = Cylinder{0.5, 2.0};
  const Overlap standing = certified->overlap(cylinder, at(3, 1, 0), floor, Pose{});
  CHECK((standing.point - Vector3(3, 0, 0)).norm() <= 1e-12);
  CHECK(standing.overlapping);
  const Overlap lying = certified->overlap(cylinder, at(0, 0.5, 0, {0, 0, pi / 2}), floor, Pose{});
  CHECK((lying.point - Vector3(0, 0, 0)).norm() <= 1e-12);
  const Shape capsule = Capsule{0.25, 1.0};
  const ContactManifold m =
      certified->manifold(capsule, at(0, 0.25, 0, {0, 0, pi / 2}), floor, Pose{}, 1e-6);
  CHECK(m.size == 2);
  const Shape box = Box{{2, 0.5, 2}};
  const ContactManifold on_box =
      certified->manifold(capsule, at(0, 0.25, 0, {0, 0, pi / 2}), box, at(0, -0.5, 0), 1e-6);
  CHECK(on_box.size == 2);
  CHECK(std::abs(on_box.normal.y() + 1.0) <= 1e-12);
}

TEST_CASE("points whose volume rounding hides are no hull", "[hull]") {
  for (const double high : {0.0, 1e-16, 1e-14}) {
    CAPTURE(high);
    const std::vector<Vector3> points{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, high, 1}};
    CHECK_THROWS_AS(convex_hull(points), std::invalid_argument);
  }
}

// Their gap stays as it is, while the place at which they are nearest runs along both. What is
// round counts the length of the direction across two edges, and that by its own rate: as fast as
// it could change at most, a look told nothing about more than 1e-10 s.
TEST_CASE("capsules that slide along each other, nearly in touch, take few looks", "[ccd]") {
  const Shape capsule = Capsule{0.1, 2.0};
  for (const double angle : {0.1, 0.5, 1.2}) {
    for (const double gap : {1e-9, 1e-7}) {
      CAPTURE(angle, gap);
      const Quaternion lying = rotate(Vector3(0, 0, -0.5 * pi), Quaternion::Identity());
      const Quaternion across = rotate(Vector3(0, angle, 0), lying);
      const Pose above{{0.3, 0.2 + gap, 0.02}, across};
      const Motion slides = moving(above, {1.0, 0.0, 0.5}, {0.0, 5.0, 0.0});
      const auto certified = ccd::make_certified();
      const TimeOfImpact toi = certified->time_of_impact(
          {capsule, moving(Pose{Vector3::Zero(), lying}, Vector3::Zero())}, {capsule, slides},
          {Instant{}, 1e-3}, 0.0);
      CHECK(toi.status == ToiStatus::separated);
      CHECK(toi.evaluations < 200);
    }
  }
}
