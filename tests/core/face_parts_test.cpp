// Faces of several pieces: where a point on its way leaves them, and what stands above them.

#include "core/contacts/face_parts.hpp"

#include "core/compound_body.hpp"
#include "core/mesh_body.hpp"
#include "core/random.hpp"
#include "core/schemes/shared/support.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <limits>
#include <vector>

using namespace kairos;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A square of 3 by 3 cells of 1 m at y = 0, without the middle one and a corner, and a cell that
/// rises to y = 1 beside it.
Mesh holed() {
  MeshData data;
  for (int i = 0; i <= 4; ++i) {
    for (int k = 0; k <= 3; ++k) {
      data.vertices.emplace_back(i, i == 4 ? 1.0 : 0.0, k);
    }
  }
  const auto at = [](int i, int k) { return static_cast<std::uint32_t>(4 * i + k); };
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 3; ++k) {
      if ((i == 1 && k == 1) || (i == 0 && k == 0)) {
        continue;
      }
      data.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
      data.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
    }
  }
  return {mesh_in_place(data, CollisionMesh::Kind::surface)};
}

bool on_holed(double x, double z) {
  return x >= 0.0 && x <= 3.0 && z >= 0.0 && z <= 3.0 &&
         !(x > 1.0 && x < 2.0 && z > 1.0 && z < 2.0) && !(x < 1.0 && z < 1.0);
}

}  // namespace

TEST_CASE("a point leaves a face of many pieces where its pieces end, and not before",
          "[contact]") {
  const std::uint64_t seed = 20261123;
  CAPTURE(seed);
  Random random(seed, 1);
  const Shape shape = holed();
  const Pose pose{Vector3(0.3, -2.0, 1.0),
                  Quaternion(Eigen::AngleAxisd(0.7, Vector3(1, 2, -1).normalized()))};
  const Vector3 up = pose.orientation * Vector3(Vector3::UnitY());
  int passed = 0;
  for (int i = 0; i < 2000; ++i) {
    Vector3 x(random.uniform(0, 3), 0.0, random.uniform(0, 3));
    if (!on_holed(x.x(), x.z())) {
      continue;
    }
    const Vector3 v(random.uniform(-2, 2), 0.0, random.uniform(-2, 2));
    const Vector3 a(random.uniform(-1, 1), 0.0, random.uniform(-1, 1));
    const Pose start{pose.to_world(x), Quaternion::Identity()};
    const Motion point = Motion::ballistic({}, 2.0, start, {pose.orientation * v, Vector3::Zero()},
                                           pose.orientation * a);
    const double exit =
        face_exit_time(shape, Motion::at_rest({}, pose), point, up, start.position, 2.0);
    // An answer is held against the outline itself, at ten thousand times.
    double sampled = infinity;
    for (int k = 0; k <= 10'000 && sampled == infinity; ++k) {
      const double s = 2e-4 * k;
      const Vector3 now = x + s * v + 0.5 * s * s * a;
      sampled = on_holed(now.x(), now.z()) ? infinity : s;
    }
    passed += exit < 2.0 ? 1 : 0;
    if (sampled < infinity) {
      // Between two samples it may have crossed a corner: then the answer is sooner, and right.
      REQUIRE(exit <= sampled + 1e-11);
    }
    if (exit < 2.0) {
      const Vector3 there = x + exit * v + 0.5 * exit * exit * a;
      const Vector3 later = there + 1e-9 * (v + exit * a).normalized();
      REQUIRE(on_holed(there.x(), there.z()) + on_holed(later.x(), later.z()) < 2);
    }
  }
  CHECK(passed > 1000);
}

TEST_CASE("above a face stands what rises beyond its plane", "[contact]") {
  const Shape mesh = holed();
  const auto slope = above_face(mesh, Vector3::UnitY(), {0.5, 0, 2.5});
  REQUIRE(slope);
  CHECK(std::get<Mesh>(*slope).body->mesh.triangles().size() == 6);
  CHECK_FALSE(above_face(Box{{1, 1, 1}}, Vector3::UnitY(), {0, 1, 0}));
  const Pose beside{{2, 0, 0}, Quaternion::Identity()}, over{{4, 0.5, 0}, Quaternion::Identity()};
  const Shape boards = Compound{compound_in_place(
      {{Box{{1, 1, 1}}, Pose{}}, {Cylinder{1, 2}, beside}, {Box{{1, 1, 1}}, over}})};
  CHECK(parts_of_face(boards, Vector3::UnitY(), {0, 1, 0}).size() == 2);
  const auto higher = above_face(boards, Vector3::UnitY(), {0, 1, 0});
  REQUIRE(higher);
  CHECK(std::get<Compound>(*higher).body->parts.size() == 1);
  CHECK(parts_of_face(boards, Vector3::UnitY(), {4, 1.5, 0}).size() == 1);
  CHECK_FALSE(above_face(boards, Vector3::UnitY(), {4, 1.5, 0}));
  CHECK(parts_of_face(boards, Vector3(0.6, 0.8, 0), {0, 1, 0}).empty());
}
