#include "ccd/box_batch.hpp"
#include "ccd/collision_world.hpp"
#include "ccd/linear/exact_motion.hpp"
#include "ccd/mesh/mesh_queries.hpp"
#include "ccd/placed_cores.hpp"
#include "ccd/relative_boxes.hpp"
#include "core/mesh_body.hpp"
#include "core/mesh_shapes.hpp"
#include "core/random.hpp"
#include "experiments/bench/bench.hpp"
#include "experiments/bench/query_cost.hpp"
#include "experiments/bench/race_table.hpp"
#include "experiments/bench/shape_pairs.hpp"
#include "experiments/vfee/linear_families.hpp"
#include "simulation/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

namespace kairos::experiments {
namespace {

constexpr std::uint64_t seed = 20261123;
/// Queries timed at once where each takes microseconds: so few that some round is left alone.
constexpr std::size_t few = 16;

double time_of(const std::vector<RaceResult>& results, const std::string& name) {
  const auto found = std::find_if(results.begin(), results.end(),
                                  [&](const RaceResult& r) { return r.name == name; });
  return found->nanoseconds;
}

// --- Vertex and face, edge and edge ---------------------------------------------------------

void linear_bars(std::size_t count, int rounds, std::vector<Bar>& bars) {
  using enum reference::LinearFamily;
  constexpr std::array degenerate{grid,      tiny_grid,   flat,        on_a_line,
                                  at_rest,   one_moves,   translation, touch,
                                  touch_ulp, double_root, cluster,     triple_root};
  for (const ccd::LinearKind kind : {ccd::LinearKind::edge_edge, ccd::LinearKind::vertex_face}) {
    std::vector<reference::LinearFamilies> sources;
    for (const reference::LinearFamily family : degenerate) {
      for (int k = 0; k < 7; ++k) {
        sources.emplace_back(close, kind, seed + sources.size());
      }
      sources.emplace_back(family, kind, seed);
    }
    std::vector<ccd::LinearQuery> queries;
    for (std::size_t i = 0; i < count; ++i) {
      queries.push_back(sources[i % sources.size()].next());
    }
    std::vector<ccd::LinearImpact> answers(count);
    const QueryCost cost =
        cost_of(count, rounds, [&](std::size_t i) { answers[i] = ccd::linear_impact(queries[i]); });
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(count, 4096); ++i) {
      wrong += ccd::exact_impact(queries[i]).hit != answers[i].hit ? 1 : 0;
    }
    const bool edges = kind == ccd::LinearKind::edge_edge;
    const std::string name = edges ? "edge and edge" : "vertex and face";
    bars.push_back({name + ", one in 8 degenerate: mean, us", 1e-3 * cost.mean, edges ? 0.5 : 1.5});
    bars.push_back({name + ": median, us", 1e-3 * cost.median, 0.1});
    bars.push_back(
        {name + ": answers unlike those of whole numbers", static_cast<double>(wrong), 0.0});
  }
}

// --- Convex shapes ---------------------------------------------------------------------------

Contest proven_distances(const std::vector<ShapePair>& pairs) {
  return [&pairs](std::size_t first, std::size_t last, std::vector<double>& answers) {
    for (std::size_t i = first; i < last; ++i) {
      const ShapePair& pair = pairs[i];
      answers[i] = ccd::distance(pair.a, pair.start_a, pair.b, pair.start_b).lower;
    }
  };
}

/// Motions are made within the time that is measured, as the peers make theirs. `looks` counts.
Contest proven_impacts(const std::vector<ShapePair>& pairs, double tolerance,
                       std::vector<double>& looks) {
  looks.resize(pairs.size());
  return [&pairs, &looks, tolerance, detector = find_detector("certified")](
             std::size_t first, std::size_t last, std::vector<double>& answers) {
    for (std::size_t i = first; i < last; ++i) {
      const ShapePair& pair = pairs[i];
      const Motion motion_a =
          Motion::ballistic({}, 1.0, pair.start_a, pair.twist_a, Vector3::Zero());
      const Motion motion_b =
          Motion::ballistic({}, 1.0, pair.start_b, pair.twist_b, Vector3::Zero());
      const TimeOfImpact toi =
          detector->time_of_impact({pair.a, motion_a}, {pair.b, motion_b}, {{}, 1.0}, tolerance);
      answers[i] = toi.status == ToiStatus::separated ? never : toi.t_lo;
      looks[i] = toi.evaluations;
    }
  };
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void print_looks(const std::vector<double>& looks) {
  fmt::print("  {:<44}{:>12.1f}\n", "certified: looks a query", mean(looks));
}

void hull_bars(std::size_t count, int rounds, std::vector<Bar>& bars) {
  const std::vector<ShapePair> pairs = random_hull_pairs(count);
  const auto distances =
      tell(fmt::format("How far apart are two hulls of 30 corners? {} distinct pairs", count),
           beside_peers({"proven", proven_distances(pairs)}, &ShapePeer::distances, pairs), count,
           rounds, {"FCL", 1e-4, "above", few});
  bars.push_back({"hulls, distance, us", 1e-3 * time_of(distances, "proven"), 0.5});
  bars.push_back({"hulls, distance: proven / FCL", ratio(distances, "proven", "FCL"), 0.2});
  std::vector<double> looks;
  const auto impacts =
      tell(fmt::format("When do two hulls of 30 corners meet? {} distinct pairs", count),
           beside_peers({"certified", proven_impacts(pairs, 0.0, looks)}, &ShapePeer::impacts,
                        pairs, 1e-4),
           count, rounds, {"FCL", 1e-4, "late", few});
  print_looks(looks);
  bars.push_back({"hulls, time of impact, us", 1e-3 * time_of(impacts, "certified"), 2.0});
  bars.push_back(
      {"hulls, time of impact: certified / FCL", ratio(impacts, "certified", "FCL"), 0.2});
}

void cylinder_bars(std::size_t count, int rounds, std::vector<Bar>& bars) {
  const std::vector<ShapePair> pairs = random_cylinder_pairs(count);
  std::vector<double> looks;
  const auto impacts =
      tell(fmt::format("When do two cylinders meet, to 1e-9? {} distinct pairs", count),
           beside_peers({"certified", proven_impacts(pairs, 1e-9, looks)}, &ShapePeer::impacts,
                        pairs, 1e-9),
           count, rounds, {"FCL", 1e-4, "late", few});
  print_looks(looks);
  bars.push_back({"cylinders, time of impact to 1e-9: certified / FCL",
                  ratio(impacts, "certified", "FCL"), 1.0 / 3.0});
}

// --- Meshes at rest ---------------------------------------------------------------------------

/// Two tori, asked by ours and by the peers.
class Tori {
 public:
  explicit Tori(int rounds)
      : rounds_(rounds), placements_(torus_placements(256)), a_(placements_.a), b_(placements_.b) {}

  void bars(std::vector<Bar>& bars) {
    race("Do two tori touch? The first pair of triangles", "tori, first contact, us", 5.0,
         &ShapePeer::first_contact, bars, [this](const PosedMesh& a, const PosedMesh& b) {
           const ccd::MeshContact contact = queries_.collide(a, b);
           count(contact.cost);
           return contact.verdict == ccd::MeshVerdict::touching ? 0.0 : never;
         });
    race("Which triangles of two tori touch? Their number", "tori, all contacts, us", 9.0,
         &ShapePeer::all_contacts, bars, [this](const PosedMesh& a, const PosedMesh& b) {
           ccd::MeshCost cost;
           const auto pairs = static_cast<double>(queries_.touching_pairs(a, b, &cost).size());
           count(cost);
           return pairs;
         });
    race("How far apart are two tori?", "tori, distance, us", 30.0, &ShapePeer::mesh_distances,
         bars, [this](const PosedMesh& a, const PosedMesh& b) {
           const ccd::MeshDistance distance = queries_.distance(a, b);
           count(distance.cost);
           return distance.lower;
         });
    race("Are two tori within 0.05 m?", "tori, tolerance, us", 7.0, nullptr, bars,
         [this](const PosedMesh& a, const PosedMesh& b) {
           const ccd::MeshWithin answer = queries_.within(a, b, 0.05);
           count(answer.distance.cost);
           return answer.verdict == ccd::WithinVerdict::within ? 0.0 : never;
         });
  }

 private:
  void count(const ccd::MeshCost& cost) {
    cost_.box_tests += cost.box_tests;
    cost_.triangle_tests += cost.triangle_tests;
    cost_.exact_tests += cost.exact_tests;
  }

  template <typename Ask>
  void race(const std::string& title, const std::string& bar, double at_most,
            std::function<Contest(const MeshPlacements&)> ShapePeer::*query, std::vector<Bar>& bars,
            const Ask& ask) {
    cost_ = {};
    const Contest ours = [this, &ask](std::size_t first, std::size_t last,
                                      std::vector<double>& answers) {
      for (std::size_t i = first; i < last; ++i) {
        answers[i] = ask({a_, Pose{}}, {b_, placements_.poses[i]});
      }
    };
    std::vector<Racer> racers{{"proven", ours}};
    if (query != nullptr) {
      racers = beside_peers(racers.front(), query, placements_);
    }
    const std::size_t asked = placements_.poses.size();
    const auto results = tell(title, racers, asked, rounds_, {"FCL", 1e-4, "above", 1});
    const double queries = static_cast<double>(asked) * rounds_;
    fmt::print("  {:<44}{:>12.1f}{:>10.1f}{:>8.2f}\n",
               "tests of boxes, of triangles, of whole numbers",
               static_cast<double>(cost_.box_tests) / queries,
               static_cast<double>(cost_.triangle_tests) / queries,
               static_cast<double>(cost_.exact_tests) / queries);
    bars.push_back({bar, 1e-3 * results.front().nanoseconds, at_most});
  }

  int rounds_;
  MeshPlacements placements_;
  CollisionMesh a_, b_;
  ccd::MeshQueries queries_;
  ccd::MeshCost cost_;
};

// --- A large mesh in motion -------------------------------------------------------------------

void large_mesh_bars(int rounds, std::vector<Bar>& bars) {
  constexpr std::size_t flights = 64;
  MeshData data = bumpy_sphere_mesh(132, 264, 0.1);
  const auto count = static_cast<double>(data.triangles.size());
  const auto start = query_cost::Clock::now();
  const CollisionMesh mesh(data);
  const double build = 1e-6 * query_cost::nanoseconds(query_cost::Clock::now() - start);
  const Shape shape = Mesh{solid_body(std::move(data)).body};
  const std::vector<MotionPair> pairs = random_flights(flights);
  const auto detector = find_detector("certified");
  std::vector<double> looks(flights);
  std::size_t hits = 0;
  const QueryCost cost = cost_of(flights, rounds, [&](std::size_t i) {
    const TimeOfImpact toi =
        detector->time_of_impact({shape, pairs[i].a}, {shape, pairs[i].b}, {{}, 1.0}, 1e-9);
    hits += toi.status == ToiStatus::separated ? 0 : 1;
    looks[i] = toi.evaluations;
  });
  fmt::print(
      "When does a mesh of {} triangles meet another? {} flights, to 1e-9 m\n"
      "  {:<44}{:>12.1f}\n  {:<44}{:>12.1f}\n  {:<44}{:>12.2f}\n",
      count, flights, "certified: looks a query", mean(looks), "median, us", 1e-3 * cost.median,
      "of them meet", static_cast<double>(hits) / (2.0 * static_cast<double>(rounds) * flights));
  bars.push_back({"70k triangles, time of impact to 1e-9: mean, ms", 1e-6 * cost.mean, 0.15});
  bars.push_back({"70k triangles, time of impact to 1e-9: 99 %, ms", 1e-6 * cost.p99, 0.5});
  bars.push_back({"70k triangles, build, ms", build, 80.0});
  bars.push_back(
      {"70k triangles, bytes a triangle", static_cast<double>(mesh.memory()) / count, 80.0});
}

// --- Oriented boxes, one by one and many at once
// ---------------------------------------------------------------

void box_bars(std::size_t count, int rounds, std::vector<Bar>& bars) {
  const std::vector<BoxPair> pairs = random_box_pairs(count, 1.4, 0.0);
  std::vector<ccd::RelativeBoxes> boxes;
  for (const BoxPair& pair : pairs) {
    boxes.emplace_back(pair.a, pair.start_a, pair.b, pair.start_b);
  }
  const Contest ours = [&boxes](std::size_t first, std::size_t last, std::vector<double>& answers) {
    for (std::size_t i = first; i < last; ++i) {
      const double error = boxes[i].error();
      const double gap = ccd::greatest_separation(boxes[i]).gap();
      answers[i] = gap > error ? never : 0.0;
    }
  };
  constexpr std::size_t together = 512;
  static_assert(long_chunk % together == 0);
  std::vector<ccd::BoxBatch> batches;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (i % together == 0) {
      batches.emplace_back();
      batches.back().reserve(together);
    }
    batches.back().push_back(boxes[i]);
  }
  std::vector<ccd::AxisSeparation> separations(together);
  std::vector<double> errors(together);
  const Contest batch = [&](std::size_t first, std::size_t last, std::vector<double>& answers) {
    for (std::size_t i = first; i < last; i += together) {
      const ccd::BoxBatch& pairs_here = batches[i / together];
      const std::size_t here = pairs_here.size();
      ccd::greatest_separation_batch(pairs_here, std::span(separations).first(here),
                                     std::span(errors).first(here));
      for (std::size_t k = 0; k < here; ++k) {
        answers[i + k] = separations[k].gap() > errors[k] ? never : 0.0;
      }
    }
  };
  std::vector<ccd::Verdict> verdicts(together);
  const Contest verdict = [&](std::size_t first, std::size_t last, std::vector<double>& answers) {
    for (std::size_t i = first; i < last; i += together) {
      const std::size_t here = batches[i / together].size();
      ccd::classify_batch(batches[i / together], std::span(verdicts).first(here));
      for (std::size_t k = 0; k < here; ++k) {
        answers[i + k] = verdicts[k] == ccd::Verdict::separated ? never : 0.0;
      }
    }
  };
  const auto results =
      tell(fmt::format("Which axis separates two boxes most, and is it proven? {} pairs", count),
           std::vector<Racer>{{"many at once", batch},
                              {"one by one", ours},
                              {"many at once, the verdict alone", verdict}},
           count, rounds, {});
  bars.push_back(
      {"oriented boxes with bound and witness, ns", time_of(results, "many at once"), 3.0});
}

// --- Many hulls from frame to frame -----------------------------------------------------------

void crowd_bars(int rounds, std::vector<Bar>& bars) {
  constexpr std::size_t count = 1000;
  constexpr int frames = 60;
  const DriftingHulls at_first(count);
  double least = never, forgetful = never;
  std::int64_t near = 0, reminded = 0;
  std::size_t overlapping = 0;
  for (int round = 0; round < rounds; ++round) {
    ccd::CollisionWorld world(count);
    DriftingHulls hulls = at_first;
    for (std::size_t i = 0; i < count; ++i) {
      world.put(i, hulls.shapes[i], hulls.poses[i]);
    }
    near = reminded = 0;
    overlapping = 0;
    for (int frame = 0; frame < frames; ++frame) {
      const auto start = query_cost::Clock::now();
      for (std::size_t i = 0; i < count; ++i) {
        world.move(i, hulls.poses[i]);
      }
      overlapping += world.touching().size();
      const double time = query_cost::nanoseconds(query_cost::Clock::now() - start);
      double& kept = frame > 0 ? least : forgetful;  // the first frame remembers nothing
      kept = std::min(kept, time);
      if (frame > 0) {
        near += world.cost().near;
        reminded += world.cost().reminded;
      }
      hulls.drift();
    }
  }
  const auto later = static_cast<double>(frames - 1);
  fmt::print(
      "Which of {} hulls overlap? {} frames\n  {:<44}{:>12.1f}\n  {:<44}{:>12.1f}\n"
      "  {:<44}{:>12.1f}\n  {:<44}{:>12.2f}\n",
      count, frames, "pairs whose boxes overlap, a frame", static_cast<double>(near) / later,
      "of them apart along last frame's direction", static_cast<double>(reminded) / later,
      "pairs that overlap", static_cast<double>(overlapping) / frames,
      "the first frame, which remembers nothing, ms", 1e-6 * forgetful);
  bars.push_back({"1,000 hulls, a frame, ms", 1e-6 * least, 1.0});
}

}  // namespace

void bench_shapes(std::size_t pairs, int rounds) {
  std::vector<Bar> bars;
  linear_bars(pairs, rounds, bars);
  hull_bars(pairs, rounds, bars);
  cylinder_bars(pairs, rounds, bars);
  Tori(rounds).bars(bars);
  large_mesh_bars(rounds, bars);
  box_bars(pairs, rounds, bars);
  crowd_bars(rounds, bars);
  print_bars(bars);
}

}  // namespace kairos::experiments
