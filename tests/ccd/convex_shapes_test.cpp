// Capsules, cylinders, cones and hulls against what is known exactly: distances, depths, first
// contacts. y is up.

#include "ccd/certified.hpp"
#include "ccd/core_witness.hpp"
#include "ccd/placed_cores.hpp"
#include "core/random.hpp"
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

// Where n is across the rim and across what crosses it, at the same place, and leads out of both,
// both are on either side of a plane across n, as far apart as these places: however near to its
// axis n is, which is where a search finds no slope.
TEST_CASE("a flat end whose rim crosses an edge, or another rim, at hardly any angle",
          "[convex][gap]") {
  const std::uint32_t seed = 20261201;
  Random random(seed);
  CAPTURE(seed);
  const auto direction = [&] {
    Vector3 v;
    for (int k = 0; k < 3; ++k) {
      v[k] = random.uniform(-1.0, 1.0);
    }
    return Vector3(v.normalized());
  };
  // Rotates the first axis to x, and the second to y.
  const auto turned = [](const Vector3& first, const Vector3& second, const Vector3& x,
                         const Vector3& y) {
    Matrix3 from;
    from << first, second, first.cross(second);
    Matrix3 to;
    to << x, y, x.cross(y);
    return Quaternion(Matrix3(to * from.transpose())).normalized();
  };
  constexpr double rounded = 4e-15;  // roundoff of places and rotations, of bodies of 0.3 m
  // So much less is found at most (4e-7 before edges were crossed with rims): two rims at 1e-3 rad
  // to each other are searched for no further. What counts as touch is a hundred times as much.
  constexpr double missed = 2e-12;
  for (int trial = 0; trial < 2000; ++trial) {
    const double radius = random.uniform(0.05, 0.2);
    const double half = random.uniform(0.01, 0.2);
    const double gap = std::pow(10.0, random.uniform(-13.0, -3.0));
    const double off = std::pow(10.0, random.uniform(-13.0, -1.0));  // of n from the axis, rad
    const Vector3 n = direction();
    const Vector3 tangent = n.cross(direction()).normalized();
    // The rim at the origin of the world: its axis and its way out are n turned about the tangent.
    const Vector3 beside = tangent.cross(n);
    const Vector3 axis = std::cos(off) * n + std::sin(off) * beside;
    const Vector3 out = -std::cos(off) * beside + std::sin(off) * n;
    const bool is_cone = random.uniform(0.0, 1.0) < 0.3;
    const Vector3 to_rim = is_cone ? Vector3(radius, -0.5 * half, 0.0) : Vector3(radius, half, 0.0);
    const Shape a = is_cone ? Shape(Cone{radius, 2.0 * half}) : Shape(Cylinder{radius, 2.0 * half});
    const Quaternion q_a =
        turned(Vector3::UnitX(), (is_cone ? -1.0 : 1.0) * Vector3::UnitY(), out, axis);
    const Pose at_a{-(q_a * to_rim), q_a};
    // An edge of a box along `along`, which goes into the disc; or the rim of a cylinder.
    const double angle = random.uniform(0.3, pi - 0.3);
    const Vector3 along = std::cos(angle) * tangent + std::sin(angle) * n.cross(tangent);
    const Vector3 across = along.cross(n);
    Shape b = Box{{0.15, 0.1, 0.3}};
    Vector3 to_b(-0.15, -0.1, random.uniform(-0.1, 0.1));
    Quaternion q_b;
    if (random.uniform(0.0, 1.0) < 0.5) {
      const double lean = random.uniform(0.1, 1.4);
      // Both faces of the edge lead away from n.
      q_b = turned(Vector3::UnitZ(), Vector3::UnitX(), along,
                   std::cos(lean) * n - std::sin(lean) * across);
    } else {
      const double r = random.uniform(0.05, 0.2);
      const double lean = std::pow(10.0, random.uniform(-13.0, -0.3));
      b = Cylinder{r, 0.1};
      to_b = {r, -0.05, 0.0};
      q_b = turned(Vector3::UnitZ(), Vector3::UnitY(), along,
                   std::cos(lean) * n - std::sin(lean) * across);
    }
    const Pose at_b{gap * n - q_b * to_b, q_b};
    const Overlap found = ccd::measure_cores(a, at_a, b, at_b);
    const Overlap other = ccd::measure_cores(b, at_b, a, at_a);
    CAPTURE(trial, gap, off, is_cone);
    for (const double measured : {found.gap, other.gap}) {
      CHECK(measured <= gap + rounded);
      CHECK(measured >= gap - missed);
    }
  }
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
