// Problems about meshes and compounds whose answers are known.

#include "ccd/certified.hpp"
#include "ccd/parts_at_rest.hpp"
#include "core/compound_body.hpp"
#include "core/mesh_body.hpp"
#include "core/mesh_shapes.hpp"
#include "tests/catch.hpp"

#include <numbers>

using namespace kairos;

namespace {

using Kind = CollisionMesh::Kind;
constexpr double pi = std::numbers::pi;

const auto certified = ccd::make_certified();

Motion moving(const Vector3& position, const Vector3& velocity, const Vector3& spin,
              const Vector3& acceleration = Vector3::Zero()) {
  return Motion::ballistic(Instant{}, 10.0, {position, Quaternion::Identity()}, {velocity, spin},
                           acceleration);
}
Motion still() { return moving(Vector3::Zero(), Vector3::Zero(), Vector3::Zero()); }

TimeOfImpact ask(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b,
                 double duration = 1.0) {
  return certified->time_of_impact({a, motion_a}, {b, motion_b}, {Instant{}, duration}, 0.0);
}

/// The answer is in the bracket, and that is narrow.
void check_bracket(const TimeOfImpact& toi, double answer, double width) {
  CAPTURE(toi.t_lo, toi.t_hi, answer);
  REQUIRE(toi.status == ToiStatus::impact);
  CHECK(toi.t_lo <= answer * (1.0 + 1e-15));
  CHECK(toi.t_hi >= answer * (1.0 - 1e-15));
  CHECK(toi.t_hi - toi.t_lo < width);
}

MeshData moved(MeshData mesh, const Vector3& by) {
  for (Vector3& v : mesh.vertices) {
    v += by;
  }
  return mesh;
}

/// One mesh of two.
MeshData together(MeshData a, const MeshData& b) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) {
    a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return a;
}

Pose at(const Vector3& position) { return {position, Quaternion::Identity()}; }

}  // namespace

TEST_CASE("parts touch where they are lowest, though their gap was told too small", "[parts]") {
  const Quaternion tilted =
      Eigen::AngleAxisd(0.5, Vector3::UnitX()) * Eigen::AngleAxisd(0.3, Vector3::UnitZ());
  const MeshData data = box_mesh({0.1, 0.2, 0.3});
  const Shape box = Mesh{solid_body(data).body};
  Vector3 corner = Vector3::Zero();
  for (const Vector3& v : data.vertices) {
    const Vector3 turned = tilted * v;
    corner = turned.y() < corner.y() ? turned : corner;
  }
  for (const double height : {0.5, 1e-12}) {
    const Pose pose{{1.0, height - corner.y(), 2.0}, tilted};
    const Vector3 point =
        ccd::touching_point(box, pose, HalfSpace{}, {}, -Vector3::UnitY(), 0.0, 1e-15);
    // Halfway between the corner and the plane; roundoff of three rotations.
    CHECK((point - (pose.position + corner - 0.5 * height * Vector3::UnitY())).norm() < 1e-15);
  }
}

TEST_CASE("16: a dumbbell that turns onto a plane", "[parts]") {
  // Balls of radius .1 at 0.5 from the middle, which stays at .35: 0.5 sin(3 t) = .25.
  const Shape dumbbell = Compound{
      compound_body({{Sphere{0.1}, at({0.5, 0, 0})}, {Sphere{0.1}, at({-0.5, 0, 0})}}).body};
  const TimeOfImpact toi =
      ask(dumbbell, moving({0, 0.35, 0}, Vector3::Zero(), {0, 0, 3.0}), HalfSpace{}, still());
  check_bracket(toi, pi / 18.0, 1e-12);
}

TEST_CASE("18: a ball over a square hole", "[parts]") {
  // Four slabs leave a unit hole open, tops at y = 0: a ball of radius r touches all four edges
  // when its centre is at sqrt(r^2 - 1/4).
  const Vector3 along_x(1.0, 0.1, 0.25);
  const Vector3 along_z(0.25, 0.1, 0.5);
  MeshData frame = moved(box_mesh(along_x), {0.0, -0.1, 0.75});
  frame = together(frame, moved(box_mesh(along_x), {0.0, -0.1, -0.75}));
  frame = together(frame, moved(box_mesh(along_z), {0.75, -0.1, 0.0}));
  frame = together(frame, moved(box_mesh(along_z), {-0.75, -0.1, 0.0}));
  const Shape hole = Mesh{mesh_in_place(frame, Kind::surface)};
  const Motion falling = moving({0, 1.0, 0}, {0, -1.0, 0}, Vector3::Zero());
  check_bracket(ask(Sphere{0.51}, falling, hole, still()), 1.0 - 0.1004987562112089, 1e-11);
  CHECK(ask(Sphere{0.49}, falling, hole, still(), 5.0).status == ToiStatus::separated);
  CHECK(ask(Sphere{0.51}, falling, Hull{hull_in_place(frame.vertices)}, still()).t_hi <
        0.5);  // the hull has no hole
}

TEST_CASE("22: meshes of unit cubes that meet face to face", "[parts]") {
  const Shape cube = Mesh{solid_body(box_mesh(Vector3::Constant(0.5))).body};
  const Motion b = moving({0.25, 2.0, -0.125}, {0, -2.0, 0}, Vector3::Zero());
  check_bracket(ask(cube, still(), cube, b), 0.5, 1e-11);
}

TEST_CASE("24: a peg slides in a slot with a clearance of 1e-9", "[parts]") {
  const double clearance = 1e-9;
  MeshData walls = moved(box_mesh({5.0, 0.5, 1.0}), {0.0, 0.75 + clearance, 0.0});
  walls = together(walls, moved(box_mesh({5.0, 0.5, 1.0}), {0.0, -0.75 - clearance, 0.0}));
  const Shape slot = Mesh{mesh_in_place(walls, Kind::surface)};
  const Shape peg = Mesh{solid_body(box_mesh({0.5, 0.25, 0.5})).body};
  const Motion sliding = moving({-3.0, 0, 0}, {1.0, 0, 0}, Vector3::Zero());
  CHECK(ask(slot, still(), peg, sliding, 5.0).status == ToiStatus::separated);
  // Tilted by as little as a clearance over a half-length it touches.
  const Motion turning = moving({-3.0, 0, 0}, {1.0, 0, 0}, {0, 0, 1e-8});
  const TimeOfImpact toi = ask(slot, still(), peg, turning, 5.0);
  CAPTURE(toi.t_lo, toi.t_hi);
  REQUIRE(toi.status == ToiStatus::impact);
  CHECK(toi.t_lo <= 0.2 + 1e-6);
  CHECK(toi.t_hi >= 0.2 - 1e-6);
}

TEST_CASE("26: a mesh and its hull on a plane", "[parts]") {
  const MeshData torus = torus_mesh(1.0, 0.25, 18, 37);
  const Shape mesh = Mesh{mesh_in_place(torus, Kind::surface)};
  const Shape hull = Hull{hull_in_place(torus.vertices)};
  const Motion falling = moving({0.1, 2.0, -0.3}, {0.2, -1.0, 0}, {1.0, 2.0, 0.5}, {0, -9.8, 0});
  const TimeOfImpact of_mesh = ask(mesh, falling, HalfSpace{}, still(), 2.0);
  const TimeOfImpact of_hull = ask(hull, falling, HalfSpace{}, still(), 2.0);
  REQUIRE(of_mesh.status == ToiStatus::impact);
  CHECK(of_mesh.t_lo == of_hull.t_lo);
  CHECK(of_mesh.t_hi == of_hull.t_hi);
}

TEST_CASE("27: a small solid inside a larger one", "[parts]") {
  const MeshData large = torus_mesh(1.0, 0.4, 24, 16);
  const MeshData small = box_mesh(Vector3::Constant(0.05));
  const Motion inside = moving({1.0, 0, 0}, Vector3::Zero(), Vector3::Zero());
  const auto solid = [](const MeshData& mesh) { return Mesh{mesh_in_place(mesh, Kind::solid)}; };
  const auto surface = [](const MeshData& mesh) {
    return Mesh{mesh_in_place(mesh, Kind::surface)};
  };
  CHECK(ask(solid(large), still(), solid(small), inside).status == ToiStatus::overlapping);
  CHECK(ask(Sphere{0.05}, inside, solid(large), still()).status == ToiStatus::overlapping);
  CHECK(ask(surface(large), still(), surface(small), inside).status == ToiStatus::separated);
  CHECK(certified->overlaps(solid(large), at(Vector3::Zero()), solid(small), at({1.0, 0, 0})));
  // In the hole of the ring it is outside.
  CHECK_FALSE(
      certified->overlaps(solid(large), at(Vector3::Zero()), solid(small), at(Vector3::Zero())));
}

TEST_CASE("every triangle is asked: a ball, and the corner of a mesh, on the middle of each",
          "[parts][mutation]") {
  // Nothing else is near there, so that no neighbour answers for a leaf or a child that is dropped.
  const MeshData sphere = icosphere_mesh(1);
  const Shape target = Mesh{mesh_in_place(sphere, Kind::surface)};
  for (std::size_t i = 0; i < sphere.triangles.size(); ++i) {
    const Triangle& t = sphere.triangles[i];
    const Vector3 &x = sphere.vertices[t[0]], &y = sphere.vertices[t[1]],
                  &z = sphere.vertices[t[2]];
    const Vector3 middle = (x + y + z) / 3.0;
    const Vector3 n = (y - x).cross(z - x).normalized();
    const Vector3 across = (y - x).normalized();
    const Vector3 along = n.cross(across);
    const MeshData corner{{Vector3::Zero(), 0.2 * n + 0.1 * across, 0.2 * n + 0.1 * along,
                           0.2 * n - 0.1 * across - 0.1 * along},
                          {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
    const std::pair<Shape, double> strikers[] = {{Sphere{0.02}, 0.02},
                                                 {Mesh{mesh_in_place(corner, Kind::surface)}, 0.0}};
    for (const auto& [striker, reach] : strikers) {
      const Motion falling = moving(middle + (0.5 + reach) * n, -n, Vector3::Zero());
      for (const TimeOfImpact& toi :
           {ask(target, still(), striker, falling), ask(striker, falling, target, still())}) {
        CAPTURE(i, reach, toi.t_lo, toi.t_hi);
        REQUIRE(toi.status == ToiStatus::impact);
        CHECK(std::abs(toi.t_lo - 0.5) < 1e-12);
        CHECK(std::abs(toi.t_hi - 0.5) < 1e-12);
      }
      const Pose inside = at(middle + (reach - 1e-6) * n);
      const Pose outside = at(middle + (reach + 1e-6) * n);
      CAPTURE(i, reach);
      CHECK(certified->overlaps(target, at(Vector3::Zero()), striker, inside));
      CHECK_FALSE(certified->overlaps(target, at(Vector3::Zero()), striker, outside));
    }
  }
}
