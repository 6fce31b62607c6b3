// Meshes that deform: every vertex and face, and every two edges, that meet within a step, against
// all pairs asked one by one; the front against the search from the roots.

#include "ccd/certified.hpp"
#include "ccd/deforming/deforming_pair.hpp"
#include "core/error.hpp"
#include "core/mesh_body.hpp"
#include "core/mesh_shapes.hpp"
#include "core/random.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <tuple>

using namespace kairos;
using namespace kairos::ccd;

namespace {

constexpr std::uint64_t seed = 20261123;

using Told = std::tuple<double, double, MeetingKind, std::uint32_t, std::uint32_t>;

std::vector<Told> told(const std::vector<Meeting>& meetings) {
  std::vector<Told> out;
  for (const Meeting& m : meetings) {
    out.emplace_back(m.impact.t_lo, m.impact.t_hi, m.kind, m.a, m.b);
  }
  return out;
}

/// A mesh at both ends of a step.
struct Step {
  const DeformingMesh& mesh;
  [[nodiscard]] Vector3 at(int end, std::uint32_t vertex) const {
    return (end == 0 ? mesh.start() : mesh.end())[vertex];
  }
};

/// All pairs, one by one, without a tree and without owners.
class AllPairs {
 public:
  AllPairs(const DeformingMesh& a, const DeformingMesh& b, double separation)
      : a_{a}, b_{b}, self_(&a == &b), options_{separation} {
    faces(a_, b_, MeetingKind::vertex_face);
    if (!self_) {
      faces(b_, a_, MeetingKind::face_vertex);
    }
    edges();
    std::sort(told_.begin(), told_.end());
  }
  [[nodiscard]] const std::vector<Told>& told() const { return told_; }

 private:
  void faces(const Step& of_vertex, const Step& of_face, MeetingKind kind) {
    std::set<std::uint32_t> vertices;
    for (const Triangle& t : of_vertex.mesh.triangles()) {
      vertices.insert(t.begin(), t.end());
    }
    for (const std::uint32_t v : vertices) {
      for (std::uint32_t f = 0; f < of_face.mesh.triangles().size(); ++f) {
        const Triangle& t = of_face.mesh.triangles()[f];
        if (self_ && std::count(t.begin(), t.end(), v) > 0) {
          continue;
        }
        FourPoints points[2];
        for (int end = 0; end < 2; ++end) {
          points[end] = {of_vertex.at(end, v), of_face.at(end, t[0]), of_face.at(end, t[1]),
                         of_face.at(end, t[2])};
        }
        const bool first = kind == MeetingKind::vertex_face;
        add(kind, first ? v : f, first ? f : v, vertex_face(points[0], points[1], options_));
      }
    }
  }
  void edges() {
    const auto& of_a = a_.mesh.edges();
    const auto& of_b = b_.mesh.edges();
    for (std::uint32_t i = 0; i < of_a.size(); ++i) {
      for (std::uint32_t j = self_ ? i + 1 : 0; j < of_b.size(); ++j) {
        const MeshEdge& e = of_a[i];
        const MeshEdge& f = of_b[j];
        if (self_ && (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1])) {
          continue;
        }
        FourPoints points[2];
        for (int end = 0; end < 2; ++end) {
          points[end] = {a_.at(end, e[0]), a_.at(end, e[1]), b_.at(end, f[0]), b_.at(end, f[1])};
        }
        add(MeetingKind::edge_edge, i, j, edge_edge(points[0], points[1], options_));
      }
    }
  }
  void add(MeetingKind kind, std::uint32_t a, std::uint32_t b, const LinearImpact& impact) {
    if (impact.hit) {
      told_.emplace_back(impact.t_lo, impact.t_hi, kind, a, b);
    }
  }

  Step a_, b_;
  bool self_;
  LinearOptions options_;
  std::vector<Told> told_;
};

/// A soup: corners anywhere among the vertices, degenerate triangles included; on a grid, where
/// much is coplanar, collinear and exactly in touch, or not.
MeshData soup(Random& random, bool grid, std::uint32_t vertices, int triangles) {
  MeshData data;
  for (std::uint32_t i = 0; i < vertices; ++i) {
    Vector3 p;
    for (double& x : p) {
      x = grid ? static_cast<double>(random.below(5)) : random.uniform(-1.0, 1.0);
    }
    data.vertices.push_back(p);
  }
  const auto corner = [&] { return static_cast<std::uint32_t>(random.below(vertices)); };
  for (int i = 0; i < triangles; ++i) {
    data.triangles.push_back({corner(), corner(), corner()});
  }
  return data;
}

/// Where the vertices go next: all together, each its own way, or nowhere.
std::vector<Vector3> moved(Random& random, bool grid, const std::vector<Vector3>& from) {
  std::vector<Vector3> to = from;
  const auto step = [&]() -> Vector3 {
    if (grid) {
      return Vector3(static_cast<double>(random.below(3)), static_cast<double>(random.below(3)),
                     static_cast<double>(random.below(3))) -
             Vector3::Ones();
    }
    const double length = random.uniform(0.0, 0.5);
    return length * random.direction();
  };
  const auto way = random.below(3);
  const Vector3 together = step();
  for (Vector3& p : to) {
    p += way == 0 ? together : way == 1 ? step() : Vector3::Zero();
  }
  return to;
}

/// A square sheet in n x n cells of two triangles, in the plane z = height, of side 2 about the
/// axis.
MeshData sheet(int n, double height) {
  MeshData data;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      data.vertices.emplace_back(2.0 * i / n - 1.0, 2.0 * j / n - 1.0, height);
    }
  }
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(i * (n + 1) + j); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      data.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      data.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return data;
}

std::vector<Vector3> shifted(std::vector<Vector3> points, const Vector3& by) {
  for (Vector3& p : points) {
    p += by;
  }
  return points;
}

}  // namespace

TEST_CASE("deforming: all that meet in a step, as asked one by one", "[deforming]") {
  CAPTURE(seed);
  Random random(seed, 1);
  std::size_t met = 0, silent = 0;
  for (int i = 0; i < 150; ++i) {
    const bool grid = i % 2 == 0;
    const double separation = i % 3 == 0 ? 0.0625 * static_cast<double>(random.below(8)) : 0.0;
    const auto make = [&] {
      const auto vertices = static_cast<std::uint32_t>(3 + random.below(14));
      const int triangles = static_cast<int>(1 + random.below(12));
      return soup(random, grid, vertices, triangles);
    };
    DeformingMesh a(make()), b(make());
    const DeformingPair::Options options{.separation = separation};
    const DeformingPair::Options rootward{.separation = separation, .keeps_front = false};
    DeformingPair pair(a, b, options), from_roots(a, b, rootward), self(a, options);
    for (int step = 0; step < 6; ++step) {
      CAPTURE(i, step, grid, separation);
      a.move_to(moved(random, grid, a.end()));
      b.move_to(moved(random, grid, b.end()));
      const std::vector<Told> truth = AllPairs(a, b, separation).told();
      REQUIRE(told(pair.meetings()) == truth);
      REQUIRE(told(from_roots.meetings()) == truth);
      REQUIRE(told(self.meetings()) == AllPairs(a, a, separation).told());
      met += truth.size();
      silent += truth.empty() ? 1 : 0;
    }
  }
  CHECK(met > 1000);
  CHECK(silent > 100);
}

TEST_CASE("deforming: a sheet sinks onto a corner at the time that arithmetic says",
          "[deforming]") {
  // A tetrahedron, its apex at (0.25, 0.125, 0.5), inside a triangle; a sheet from z = 1 to z = -1.
  MeshData tip;
  tip.vertices = {{0.25, 0.125, 0.5}, {1.0, 0.0, -2.0}, {-1.0, 1.0, -2.0}, {-1.0, -1.0, -2.0}};
  tip.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  DeformingMesh cloth(sheet(8, 1.0));
  const DeformingMesh rock(tip);
  DeformingPair pair(cloth, rock);
  CHECK(pair.meetings().empty());
  cloth.move_to(shifted(cloth.end(), {0.0, 0.0, -2.0}));
  const std::vector<Meeting>& met = pair.meetings();
  REQUIRE_FALSE(met.empty());
  CHECK(met.front().impact.t_lo == 0.25);
  CHECK(met.front().impact.t_hi == 0.25);
  CHECK(pair.cost().queries_by_stage[0] > 0);
  // x = 0.25 is a line between cells: the edge on it and both faces beside it meet the apex.
  const auto at_once =
      std::count_if(met.begin(), met.end(), [](const Meeting& m) { return m.impact.t_lo == 0.25; });
  CHECK(at_once > 1);

  DeformingPair wide(cloth, rock, {.separation = 0.25});
  CHECK(wide.meetings().front().impact.t_lo == 0.125);
}

TEST_CASE("deforming: a sheet folds onto itself", "[deforming]") {
  // A strip of two hinged squares; the outer one turns over, on straight lines, through the inner.
  MeshData strip;
  strip.vertices = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0.25, 0.25, 1}, {0.25, 0.75, 1}};
  strip.triangles = {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}};
  DeformingMesh mesh(strip);
  DeformingPair self(mesh);
  CHECK(self.meetings().empty());
  auto to = mesh.end();
  to[4].z() = -1.0;
  to[5].z() = -1.0;
  mesh.move_to(to);
  const std::vector<Meeting>& met = self.meetings();
  REQUIRE_FALSE(met.empty());
  CHECK(met.front().impact.t_lo == 0.5);
  CHECK(met.front().kind == MeetingKind::vertex_face);
}

TEST_CASE("deforming: a rigid shift meets when the certified detector says", "[deforming]") {
  CAPTURE(seed);
  Random random(seed, 2);
  const MeshData ball = icosphere_mesh(2);
  const MeshData ring = torus_mesh(1.0, 0.25, 24, 12);
  const auto certified = make_certified();
  int hits = 0;
  for (int i = 0; i < 40; ++i) {
    const Vector3 from = 3.0 * random.direction();
    const Vector3 way = 6.0 * (0.7 * random.direction() - from.normalized());
    MeshData placed = ball;
    placed.vertices = shifted(ball.vertices, from);
    DeformingMesh a(placed);
    const DeformingMesh b(ring);
    a.move_to(shifted(placed.vertices, way));
    DeformingPair pair(a, b);
    const std::vector<Meeting>& met = pair.meetings();
    const Shape shape_a = Mesh{mesh_in_place(ball, CollisionMesh::Kind::surface)};
    const Shape shape_b = Mesh{mesh_in_place(ring, CollisionMesh::Kind::surface)};
    Twist twist;
    twist.linear = way;
    const TimeOfImpact toi = certified->time_of_impact(
        {shape_a, Motion::ballistic({}, 1.0, {.position = from}, twist, Vector3::Zero())},
        {shape_b, Motion::at_rest({}, {})}, {{}, 1.0}, 0.0);
    CAPTURE(i, from.transpose(), way.transpose(), toi.t_lo, toi.t_hi, toi.status);
    if (toi.status == ToiStatus::impact) {
      REQUIRE_FALSE(met.empty());
      // Placing the mesh rounds its vertices by 2^-52 of 4 m, at some 6 m/s.
      CHECK(met.front().impact.t_lo >= toi.t_lo - 1e-14);
      CHECK(met.front().impact.t_lo <= toi.t_hi + 1e-14);
      ++hits;
    } else if (toi.status == ToiStatus::separated) {
      CHECK(met.empty());
    }
  }
  CHECK(hits > 5);
}

TEST_CASE("deforming: the front spares tests of boxes, the answer is the same", "[deforming]") {
  DeformingMesh cloth(sheet(40, 1.1));
  const DeformingMesh ball(icosphere_mesh(3));
  DeformingPair with(cloth, ball), without(cloth, ball, {.keeps_front = false});
  std::int64_t tests_with = 0, tests_without = 0;
  std::size_t met = 0;
  for (int step = 0; step < 30; ++step) {
    auto to = cloth.end();
    for (Vector3& p : to) {
      p.z() -= 0.01 * (1.0 - 0.3 * p.head<2>().squaredNorm());
    }
    cloth.move_to(to);
    const std::vector<Told> a = told(with.meetings());
    REQUIRE(a == told(without.meetings()));
    met += a.size();
    if (step > 0) {
      tests_with += with.cost().box_tests;
      tests_without += without.cost().box_tests;
    }
  }
  CHECK(met > 0);
  CAPTURE(tests_with, tests_without, with.front_size());
  CHECK(tests_with < tests_without);
}

TEST_CASE("deforming: the front goes back up where meshes part", "[deforming]") {
  DeformingMesh cloth(sheet(20, 1.0));
  const DeformingMesh ball(icosphere_mesh(2));
  DeformingPair pair(cloth, ball);
  (void)pair.meetings();
  cloth.move_to(shifted(cloth.end(), {0.0, 0.0, -0.5}));
  (void)pair.meetings();
  const std::size_t near = pair.front_size();
  for (int i = 0; i < 30; ++i) {
    cloth.move_to(shifted(cloth.end(), {0.0, 0.0, 1.0}));
    (void)pair.meetings();
  }
  CHECK(pair.front_size() == 1);
  CHECK(near > 100);
}

TEST_CASE("deforming: a tree that has become bad is built anew", "[deforming]") {
  CAPTURE(seed);
  Random random(seed, 3);
  DeformingMesh mesh(sheet(16, 0.0));
  mesh.move_to(shifted(mesh.end(), {5.0, 0.0, 0.0}));
  CHECK(mesh.builds() == 1);  // a shift changes nothing
  auto to = mesh.end();
  for (Vector3& p : to) {
    p *= 100.0;
  }
  mesh.move_to(to);
  CHECK(mesh.builds() == 1);  // nor does its size
  for (Vector3& p : to) {
    p = 100.0 * random.direction();
  }
  mesh.move_to(to);
  mesh.move_to(to);
  CHECK(mesh.builds() == 2);
  DeformingPair self(mesh);
  REQUIRE(told(self.meetings()) == AllPairs(mesh, mesh, 0.0).told());
}

TEST_CASE("deforming: numbers of any size", "[deforming]") {
  for (const double scale : {1e-300, 1.0, 1e300}) {
    CAPTURE(scale);
    MeshData a{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{0, 1, 2}}};
    MeshData b{{{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}}, {{0, 1, 2}}};
    for (MeshData* data : {&a, &b}) {
      for (Vector3& p : data->vertices) {
        p *= scale;
      }
    }
    DeformingMesh above(a);
    const DeformingMesh below(b);
    above.move_to(shifted(a.vertices, {0.0, 0.0, -2.0 * scale}));
    DeformingPair pair(above, below);
    REQUIRE_FALSE(pair.meetings().empty());
    CHECK(pair.meetings().front().impact.t_lo == 0.5);
  }
}

TEST_CASE("deforming: what makes no sense is refused, and nothing has changed", "[deforming]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const MeshData good = sheet(2, 0.0);
  CHECK_THROWS_AS(DeformingMesh(MeshData{}), InputError);
  MeshData bad = good;
  bad.triangles[3][1] = 9;
  CHECK_THROWS_WITH(DeformingMesh(bad), Catch::Contains("triangle 3") && Catch::Contains("0 to 8"));
  bad = good;
  bad.vertices[4].y() = nan;
  CHECK_THROWS_WITH(DeformingMesh(bad), Catch::Contains("vertex 4"));

  DeformingMesh mesh(good);
  const auto before = mesh.end();
  auto to = before;
  to.pop_back();
  CHECK_THROWS_WITH(mesh.move_to(to), Catch::Contains("8") && Catch::Contains("9"));
  to = before;
  to[2].x() = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(mesh.move_to(to), InputError);
  CHECK(mesh.end() == before);
  CHECK(mesh.start() == before);
  for (const double separation : {-1.0, nan, std::numeric_limits<double>::infinity()}) {
    CHECK_THROWS_AS(DeformingPair(mesh, {.separation = separation}), InputError);
  }
}
