#include "ccd/mesh/mesh_queries.hpp"
#include "core/mesh_shapes.hpp"
#include "core/random.hpp"
#include "experiments/bench/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace kairos::experiments {
namespace {

using ccd::MeshCost;
using ccd::MeshQueries;
using ccd::MeshVerdict;

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t seed = 20261122;
constexpr std::size_t placements = 256;  ///< more than a branch predictor learns
constexpr double tolerance = 0.05;       ///< m: a fifth of the tube

/// What one kind of query costs, over all placements.
struct MeshQuestion {
  std::string name;
  std::function<MeshCost(MeshQueries&, const PosedMesh&, const PosedMesh&, bool& yes)> ask;
};

std::vector<MeshQuestion> questions() {
  return {{"touching, first pair",
           [](MeshQueries& queries, const PosedMesh& a, const PosedMesh& b, bool& yes) {
             const ccd::MeshContact contact = queries.collide(a, b);
             yes = contact.verdict == MeshVerdict::touching;
             return contact.cost;
           }},
          {"touching, all pairs",
           [](MeshQueries& queries, const PosedMesh& a, const PosedMesh& b, bool& yes) {
             MeshCost cost;
             yes = !queries.touching_pairs(a, b, &cost).empty();
             return cost;
           }},
          {"distance, to rounding",
           [](MeshQueries& queries, const PosedMesh& a, const PosedMesh& b, bool& yes) {
             const ccd::MeshDistance distance = queries.distance(a, b);
             yes = distance.upper == 0.0;
             return distance.cost;
           }},
          {"within 0.05 m",
           [](MeshQueries& queries, const PosedMesh& a, const PosedMesh& b, bool& yes) {
             const ccd::MeshWithin answer = queries.within(a, b, tolerance);
             yes = answer.verdict == ccd::WithinVerdict::within;
             return answer.distance.cost;
           }}};
}

double nanoseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
}

void ask_all(const MeshQuestion& question, const CollisionMesh& mesh_a, const CollisionMesh& mesh_b,
             const std::vector<Pose>& poses, int rounds) {
  MeshQueries queries;
  const Pose origin;
  std::vector<double> times(poses.size(), std::numeric_limits<double>::infinity());
  MeshCost cost;
  double hits = 0.0;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      bool yes = false;
      const auto start = Clock::now();
      const MeshCost own = question.ask(queries, {mesh_a, origin}, {mesh_b, poses[i]}, yes);
      times[i] = std::min(times[i], nanoseconds_since(start));
      if (round == 0) {
        cost.box_tests += own.box_tests;
        cost.triangle_tests += own.triangle_tests;
        cost.exact_tests += own.exact_tests;
        hits += yes ? 1.0 : 0.0;
      }
    }
  }
  const auto count = static_cast<double>(poses.size());
  double sum = 0.0;
  for (const double time : times) {
    sum += time;
  }
  std::sort(times.begin(), times.end());
  fmt::print("  {:<24}{:>10.1f}{:>10.1f}{:>8.0f}{:>12.1f}{:>12.1f}{:>10.2f}\n", question.name,
             1e-3 * sum / count, 1e-3 * times[times.size() / 2], 100.0 * hits / count,
             static_cast<double>(cost.box_tests) / count,
             static_cast<double>(cost.triangle_tests) / count,
             static_cast<double>(cost.exact_tests) / count);
}

void bench_build() {
  MeshData data = bumpy_sphere_mesh(132, 264, 0.1);
  const auto start = Clock::now();
  const CollisionMesh mesh(std::move(data));
  const double milliseconds = 1e-6 * nanoseconds_since(start);
  const auto count = static_cast<double>(mesh.triangles().size());
  fmt::print("  tree of {} triangles: {:.1f} ms, {:.1f} bytes a triangle with the mesh, depth {}\n",
             mesh.triangles().size(), milliseconds, static_cast<double>(mesh.memory()) / count,
             mesh.tree().depth);
}

}  // namespace

void bench_meshes(int rounds) {
  const CollisionMesh mesh_a(torus_mesh(1.0, 0.25, 18, 37));
  const CollisionMesh mesh_b(torus_mesh(1.0, 0.25, 30, 54));
  std::vector<Pose> poses;
  Random random(seed);
  for (std::size_t i = 0; i < placements; ++i) {
    const double distance = random.uniform(0.5, 3.0);
    const Vector3 position = distance * random.direction();
    poses.push_back({position, random.orientation()});
  }
  fmt::print(
      "Two tori of {} and {} triangles in {} placements, answers proven\n"
      "  {:<24}{:>10}{:>10}{:>8}{:>12}{:>12}{:>10}\n",
      mesh_a.triangles().size(), mesh_b.triangles().size(), poses.size(), "", "mean, us", "median",
      "yes, %", "box tests", "triangles", "exact");
  for (const MeshQuestion& question : questions()) {
    ask_all(question, mesh_a, mesh_b, poses, rounds);
  }
  bench_build();
}

}  // namespace kairos::experiments
