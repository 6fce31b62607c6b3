// Meshes at rest: touching, distance, tolerance, solids, against rational arithmetic over all
// pairs.

#include "ccd/mesh/mesh_queries.hpp"

#include "core/error.hpp"
#include "core/mass_properties.hpp"
#include "core/mesh_shapes.hpp"
#include "core/random.hpp"
#include "tests/catch.hpp"
#ifdef KAIROS_WITH_GMP
#include "tests/ccd/mesh_reference.hpp"
#endif

#include <cmath>
#include <numbers>

using namespace kairos;
using namespace kairos::ccd;

namespace {

constexpr std::uint64_t seed = 20261122;

Pose at(const Vector3& position, const Quaternion& orientation = Quaternion::Identity()) {
  return {position, orientation};
}
Pose random_pose(Random& random, double spread) {
  const double length = spread * random.uniform();
  const Vector3 position = length * random.direction();
  return {position, random.orientation()};
}

/// Quaternions whose rotations are exact, or rational: degeneracies survive them.
Quaternion special_turn(Random& random) {
  switch (random.below(4)) {
    case 0:
      return Quaternion::Identity();
    case 1:
      return {0.0, 1.0, 0.0, 0.0};
    case 2:
      return {0.5, 0.5, -0.5, 0.5};
    default:
      return {0.6, 0.0, 0.8, 0.0};  // of length 1 to a rounding
  }
}

/// Each triangle as a mesh of its own.
std::vector<CollisionMesh> each_alone(const CollisionMesh& mesh) {
  std::vector<CollisionMesh> result;
  for (const Triangle& t : mesh.triangles()) {
    result.push_back(CollisionMesh(
        {{mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]]}, {{0, 1, 2}}}));
  }
  return result;
}

}  // namespace

#ifdef KAIROS_WITH_GMP

TEST_CASE("meshes: two triangles touch or not, exactly as in rational numbers", "[mesh]") {
  CAPTURE(seed);
  Random random(seed, 1);
  MeshQueries queries;
  int touching = 0, exact = 0, asked = 0;
  const int most[] = {1, 2, 4, 1000};
  for (int i = 0; i < 20000; ++i) {
    const int size = most[i % 4];
    MeshData data[2];
    for (MeshData& mesh : data) {
      for (int k = 0; k < 3; ++k) {
        Vector3 v;
        for (int c = 0; c < 3; ++c) {
          v[c] = static_cast<double>(random.below(static_cast<std::uint64_t>(2 * size + 1))) - size;
        }
        if (random.below(2) == 0 && i % 8 < 4) {
          v.z() = 0.0;  // coplanar ones
        }
        mesh.vertices.push_back(v);
      }
      mesh.triangles = {{0, 1, 2}};
    }
    Quaternion turn = special_turn(random);
    const Pose pose_a = at({0.25 * static_cast<double>(random.below(3)), 0, 0}, turn);
    const Pose pose_b = at({0, 0.1 * static_cast<double>(random.below(2)), 0},
                           random.below(2) == 0 ? turn : special_turn(random));
    const reference::Polygon a = reference::posed(data[0], 0, pose_a);
    const reference::Polygon b = reference::posed(data[1], 0, pose_b);
    if (!reference::has_area(a) && !reference::has_area(b)) {
      continue;
    }
    const bool truth = reference::has_area(b) ? reference::touch(a, b) : reference::touch(b, a);
    const CollisionMesh mesh_a(data[0]), mesh_b(data[1]);
    const MeshContact there = queries.collide({mesh_a, pose_a}, {mesh_b, pose_b});
    const MeshContact back = queries.collide({mesh_b, pose_b}, {mesh_a, pose_a});
    INFO("query " << i);
    REQUIRE((there.verdict == MeshVerdict::touching) == truth);
    REQUIRE(back.verdict == there.verdict);
    const MeshWithin none = queries.within({mesh_a, pose_a}, {mesh_b, pose_b}, 0.0);
    REQUIRE((none.verdict == WithinVerdict::within) == truth);
    touching += truth ? 1 : 0;
    exact += there.cost.exact_tests > 0 ? 1 : 0;
    ++asked;
  }
  // Both answers, and both stages, were asked for.
  CHECK(touching > asked / 10);
  CHECK(touching < asked - asked / 10);
  CHECK(exact > asked / 10);
  CHECK(exact < asked - asked / 10);
}

TEST_CASE("meshes: the tree finds all pairs that touch, and the distance", "[mesh][slow]") {
  CAPTURE(seed);
  Random random(seed, 2);
  MeshQueries queries;
  const MeshData shapes[] = {box_mesh({1.0, 0.5, 0.25}), icosphere_mesh(0),
                             torus_mesh(1, .25, 5, 3)};
  std::vector<CollisionMesh> meshes;
  for (const MeshData& data : shapes) {
    meshes.emplace_back(data);
  }
  std::size_t touching = 0, apart = 0;
  for (int i = 0; i < 27; ++i) {
    const auto j = static_cast<std::size_t>(i / 3 % 3), k = static_cast<std::size_t>(i / 9);
    // Two of three are aligned: faces, edges and corners meet exactly.
    const bool aligned = i % 3 > 0;
    const Pose pose_a = aligned ? at({0, 0, 0}) : random_pose(random, 0.5);
    const Pose pose_b = aligned ? at({std::array{2.0, 1.0, 0.0}[random.below(3)],
                                      std::array{0.0, 1.0, 0.5}[random.below(3)],
                                      0.25 * static_cast<double>(random.below(3))})
                                : random_pose(random, 3.0);
    const PosedMesh a{meshes[j], pose_a}, b{meshes[k], pose_b};
    std::vector<TrianglePair> truth;
    reference::Rational least = 1000;
    std::vector<reference::Polygon> of_b;
    for (std::size_t n = 0; n < shapes[k].triangles.size(); ++n) {
      of_b.push_back(reference::posed(shapes[k], n, pose_b));
    }
    for (std::uint32_t m = 0; m < shapes[j].triangles.size(); ++m) {
      const reference::Polygon p = reference::posed(shapes[j], m, pose_a);
      for (std::uint32_t n = 0; n < shapes[k].triangles.size(); ++n) {
        const auto squared = reference::squared_distance(p, of_b[n]);
        least = std::min(least, squared);
        if (squared == 0) {
          truth.push_back({m, n});
        }
      }
    }
    INFO("query " << i);
    REQUIRE(queries.touching_pairs(a, b) == truth);
    REQUIRE((queries.collide(a, b).verdict == MeshVerdict::touching) == !truth.empty());
    const MeshDistance found = queries.distance(a, b);
    using reference::Rational;
    REQUIRE(Rational(found.lower) * Rational(found.lower) <= least);
    REQUIRE(least <= Rational(found.upper) * Rational(found.upper));
    // As promised: 1e-12 of it, and roundings of coordinates below 4.
    REQUIRE(found.upper - found.lower <= 1e-12 * found.upper + 1e-12);
    REQUIRE((found.on_a - found.on_b).norm() <= found.upper + 1e-14);
    (truth.empty() ? apart : touching) += 1;
    if (truth.empty()) {
      CHECK(queries.within(a, b, found.upper * 1.0001).verdict == WithinVerdict::within);
      CHECK(queries.within(a, b, found.lower * 0.9999).verdict == WithinVerdict::beyond);
      CHECK(queries.within(a, b, 0.0).verdict == WithinVerdict::beyond);
    }
  }
  CHECK(touching > 5);
  CHECK(apart > 5);
}

#endif

TEST_CASE("meshes: what the tree leaves out is what all pairs leave out", "[mesh]") {
  CAPTURE(seed);
  Random random(seed, 3);
  MeshQueries queries;
  const CollisionMesh mesh_a(torus_mesh(1.0, 0.25, 18, 37));
  const CollisionMesh mesh_b(bumpy_sphere_mesh(9, 14, 0.2));
  const std::vector<CollisionMesh> alone_a = each_alone(mesh_a), alone_b = each_alone(mesh_b);
  MeshQueries lone;
  for (int i = 0; i < 12; ++i) {
    const Pose pose_a = random_pose(random, 1.0), pose_b = random_pose(random, 3.0);
    const PosedMesh a{mesh_a, pose_a}, b{mesh_b, pose_b};
    const std::vector<TrianglePair> pairs = queries.touching_pairs(a, b);
    const MeshDistance distance = queries.distance(a, b);
    const std::vector<NearPair> near = queries.pairs_within(a, b, 0.3);
    std::vector<TrianglePair> all;
    std::vector<TrianglePair> all_near;
    double least = 1e9;
    for (std::uint32_t m = 0; m < mesh_a.triangles().size(); ++m) {
      for (std::uint32_t n = 0; n < mesh_b.triangles().size(); n += i < 2 ? 1U : 7U) {
        // One triangle each: no box is asked.
        const MeshDistance d = lone.distance({alone_a[m], pose_a}, {alone_b[n], pose_b});
        least = std::min(least, d.upper);
        if (d.upper == 0.0) {
          all.push_back({m, n});
        }
        if (d.upper <= 0.3) {
          all_near.push_back({m, n});
        }
      }
    }
    for (const TrianglePair& pair : all) {
      REQUIRE(std::binary_search(pairs.begin(), pairs.end(), pair));
    }
    for (const TrianglePair& pair : all_near) {
      REQUIRE(
          std::any_of(near.begin(), near.end(), [&](const NearPair& x) { return x.pair == pair; }));
    }
    REQUIRE(distance.lower <= least);
    if (i < 2) {
      REQUIRE(all.size() == pairs.size());
      REQUIRE(all_near.size() == near.size());
      REQUIRE(distance.upper <= least * (1.0 + 1e-11) + 1e-12);
    }
  }
}

TEST_CASE("meshes: solids overlap where one is inside the other, surfaces do not", "[mesh]") {
  using Kind = CollisionMesh::Kind;
  MeshQueries queries;
  const CollisionMesh small(icosphere_mesh(1)), large(box_mesh({3, 3, 3}));
  const CollisionMesh small_solid(icosphere_mesh(1), Kind::solid);
  const CollisionMesh large_solid(box_mesh({3, 3, 3}), Kind::solid);
  const Pose middle = at({0, 0, 0}), beside = at({0.5, 0.25, 0}), outside = at({9, 0.125, 0});
  CHECK(queries.collide({small, beside}, {large, middle}).verdict == MeshVerdict::apart);
  CHECK(queries.distance({small, beside}, {large, middle}).lower > 1.0);
  CHECK(queries.collide({small, beside}, {large_solid, middle}).verdict == MeshVerdict::a_inside);
  CHECK(queries.collide({large_solid, middle}, {small_solid, beside}).verdict ==
        MeshVerdict::b_inside);
  CHECK(queries.collide({small_solid, middle}, {large_solid, middle}).verdict ==
        MeshVerdict::a_inside);
  CHECK(queries.distance({small_solid, beside}, {large_solid, middle}).upper == 0.0);
  CHECK(queries.within({small_solid, beside}, {large_solid, middle}, 0.1).verdict ==
        WithinVerdict::within);
  CHECK(queries.collide({small_solid, outside}, {large_solid, middle}).verdict ==
        MeshVerdict::apart);

  // In a cavity nothing is inside.
  MeshData hollow = box_mesh({3, 3, 3});
  const MeshData hole = box_mesh({2, 2, 2});
  hollow.vertices.insert(hollow.vertices.end(), hole.vertices.begin(), hole.vertices.end());
  for (const Triangle& t : hole.triangles) {
    hollow.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  }
  const CollisionMesh shell(hollow, Kind::solid);
  CHECK(queries.collide({small_solid, beside}, {shell, middle}).verdict == MeshVerdict::apart);
  CHECK(queries.collide({shell, middle}, {small_solid, beside}).verdict == MeshVerdict::apart);
  MeshData open = box_mesh({1, 1, 1});
  open.triangles.pop_back();
  CHECK_THROWS_AS(CollisionMesh(open, Kind::solid), InputError);
}

TEST_CASE("meshes: a ball on a square hole, a peg in a slot, boxes that share a face", "[mesh]") {
  MeshQueries queries;
  // Clearance 1e-9 on both sides of a peg in a slot: a box between two boxes.
  const CollisionMesh peg(box_mesh({0.5, 1, 1})), wall(box_mesh({0.25, 2, 2}));
  const Pose middle = at({0, 0.375, 0});
  for (const double side : {-1.0, 1.0}) {
    const Pose slot = at({side * (0.75 + 1e-9), 0, 0});
    CHECK(queries.collide({peg, middle}, {wall, slot}).verdict == MeshVerdict::apart);
    const MeshDistance gap = queries.distance({peg, middle}, {wall, slot});
    CHECK(gap.lower <= 1e-9 * (1 + 1e-6));
    CHECK(gap.upper >= 1e-9 * (1 - 1e-6));
    // Coordinates whose magnitudes add up to 8: 40 u of them, doubled, from both sides.
    CHECK(gap.upper - gap.lower <= 4e-13);
  }
  // Faces, then nothing but a corner, then one ulp between them.
  const CollisionMesh cube(box_mesh({0.5, 0.5, 0.5}));
  const Pose origin = at({0, 0, 0});
  CHECK(queries.collide({cube, origin}, {cube, at({1, 0, 0})}).verdict == MeshVerdict::touching);
  CHECK(queries.collide({cube, origin}, {cube, at({1, 1, 1})}).verdict == MeshVerdict::touching);
  CHECK(queries.collide({cube, origin}, {cube, at({1, 1, 1 + 0x1p-52})}).verdict ==
        MeshVerdict::apart);
  // Far from the origin nothing is lost.
  CHECK(queries.collide({cube, at({5e11, 0, 0})}, {cube, at({5e11 + 1, 0, 0})}).verdict ==
        MeshVerdict::touching);
}

TEST_CASE("mesh shapes: volumes and moments of their solids", "[mesh]") {
  const auto solid = [](const MeshData& mesh) {
    return mass_properties(mesh.vertices, mesh.triangles);
  };
  CHECK(torus_mesh(1, 0.25, 18, 37).triangles.size() == 1332);
  CHECK(torus_mesh(1, 0.25, 30, 54).triangles.size() == 3240);
  const MassProperties icosahedron = solid(icosphere_mesh(0));
  // Edge 1: 5 (3 + sqrt 5) / 12, and I/m = phi^2 / 10.
  CHECK(icosahedron.volume == Approx(5.0 * (3.0 + std::sqrt(5.0)) / 12.0).epsilon(1e-14));
  CHECK(icosahedron.moments.x() / icosahedron.volume == Approx(0.2618033988749895).epsilon(1e-13));
  // Finer tori: the volume 2 pi^2 R r^2 and I_z/m = R^2 + 3/4 r^2, as h^2.
  const double volume = 1.2337005501361698, moment = 1.046875;
  double before[2] = {};
  for (const int n : {16, 32, 64}) {
    const MassProperties torus = solid(torus_mesh(1, 0.25, 2 * n, n));
    const double error[2] = {volume - torus.volume, moment - torus.moments.z() / torus.volume};
    if (n > 16) {
      CHECK(before[0] / error[0] == Approx(4.0).margin(0.1));
      CHECK(before[1] / error[1] == Approx(4.0).margin(0.1));
    }
    before[0] = error[0];
    before[1] = error[1];
  }
  CHECK(solid(bumpy_sphere_mesh(20, 40, 0.2)).volume > 0.0);
  CHECK_THROWS_AS(torus_mesh(1, 2, 10, 10), InputError);
}
