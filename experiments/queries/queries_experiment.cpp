#include "experiments/queries/queries_experiment.hpp"

#include "ccd/collision_world.hpp"
#include "ccd/deforming/deforming_pair.hpp"
#include "ccd/mesh/mesh_queries.hpp"
#include "ccd/placed_cores.hpp"
#include "core/mesh_body.hpp"
#include "core/mesh_shapes.hpp"
#include "experiments/bench/race_table.hpp"
#include "experiments/bench/shape_pairs.hpp"
#include "experiments/progress_bar.hpp"
#include "experiments/queries/reviewed_systems.hpp"
#include "experiments/vfee/linear_families.hpp"
#include "simulation/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace kairos::experiments {
namespace {

constexpr std::uint64_t seed = 20261123;
constexpr int rounds = 3;

/// What one kind of question cost.
struct Costs {
  std::string question, unit;
  std::vector<double> work;  ///< of each that was asked
  std::size_t yes = 0;       ///< answers that something meets
};

/// Asks, counts, and lets those libraries that were found answer the same.
class Survey {
 public:
  explicit Survey(Size size) : pairs_(size == Size::full ? 4096 : 256) {
    costs_.columns = {"question", "unit", "asked", "yes", "mean", "p99", "most"};
    stages_.columns = {"question", "stage", "asked", "share"};
    timings_.columns = {"question", "by", "nanoseconds"};
  }

  void boxes();
  void hulls();
  void cylinders();
  void tori();
  void large_mesh();
  void linear();
  void cloth();
  void crowd();

  [[nodiscard]] ProgramOutput output() &&;

 private:
  void add(Costs costs);
  void add_times(const std::string& question, const std::vector<Racer>& racers, std::size_t count,
                 std::size_t chunk);
  /// `has_peers`: others answer about hulls and cylinders, not about boxes.
  void impacts(const std::string& question, const std::vector<ShapePair>& pairs, double tolerance,
               bool has_peers);

  std::size_t pairs_;
  Table costs_, stages_, timings_;
  std::size_t asked_ = 0;
};

void Survey::add(Costs costs) {
  std::vector<double>& work = costs.work;
  std::sort(work.begin(), work.end());
  double sum = 0.0;
  for (const double w : work) {
    sum += w;
  }
  const std::size_t last = work.size() - 1;
  const auto p99 = static_cast<std::size_t>(0.99 * static_cast<double>(last));
  costs_.rows.push_back({costs.question, costs.unit, static_cast<std::int64_t>(work.size()),
                         static_cast<std::int64_t>(costs.yes),
                         sum / static_cast<double>(work.size()), work[p99], work[last]});
  asked_ += work.size();
}

void Survey::add_times(const std::string& question, const std::vector<Racer>& racers,
                       std::size_t count, std::size_t chunk) {
  for (const RaceResult& result : race_in_chunks(racers, count, rounds, chunk)) {
    timings_.rows.push_back({question, result.name, number_cell(result.nanoseconds)});
  }
}

Motion flight(const Pose& start, const Twist& twist) {
  return Motion::ballistic({}, 1.0, start, twist, Vector3::Zero());
}

void Survey::impacts(const std::string& question, const std::vector<ShapePair>& pairs,
                     double tolerance, bool has_peers) {
  for (const char* name : {"certified", "conservative-advancement"}) {
    const auto detector = find_detector(name);
    Costs costs{question, fmt::format("looks, {}", name), {}, 0};
    const Contest ask = [&](std::size_t first, std::size_t last, std::vector<double>& answers) {
      for (std::size_t i = first; i < last; ++i) {
        const ShapePair& p = pairs[i];
        const Motion a = flight(p.start_a, p.twist_a);
        const Motion b = flight(p.start_b, p.twist_b);
        const TimeOfImpact toi = detector->time_of_impact({p.a, a}, {p.b, b}, {{}, 1.0}, tolerance);
        answers[i] = toi.status == ToiStatus::separated ? never : toi.t_lo;
        costs.work[i] = toi.evaluations;
      }
    };
    costs.work.resize(pairs.size());
    std::vector<double> answers(pairs.size());
    ask(0, pairs.size(), answers);
    costs.yes = static_cast<std::size_t>(
        std::count_if(answers.begin(), answers.end(), [](double t) { return std::isfinite(t); }));
    const bool proven = std::string(name) == "certified";
    add_times(question,
              proven && has_peers
                  ? beside_peers({fmt::format("kairos {}", name), ask}, &ShapePeer::impacts, pairs,
                                 std::max(tolerance, 1e-4))
                  : std::vector<Racer>{{fmt::format("kairos {}", name), ask}},
              pairs.size(), 16);
    add(std::move(costs));
  }
}

void Survey::boxes() {
  std::vector<ShapePair> pairs;
  for (const BoxPair& p : random_box_pairs(pairs_, 1.4, 0.7)) {
    pairs.push_back({p.a, p.b, p.start_a, p.start_b, p.end_a, p.end_b, p.twist_a, p.twist_b});
  }
  impacts("when do two boxes meet?", pairs, 0.0, false);
}

void Survey::hulls() {
  const std::vector<ShapePair> pairs = random_hull_pairs(pairs_);
  impacts("when do two hulls of 30 corners meet?", pairs, 0.0, true);
}

void Survey::cylinders() {
  impacts("when do two cylinders meet, to 1e-9?", random_cylinder_pairs(pairs_), 1e-9, true);
}

/// A question about meshes that a library may have.
using MeshQuestion = std::function<Contest(const MeshPlacements&)> ShapePeer::*;

void Survey::tori() {
  const MeshPlacements placements = torus_placements(pairs_);
  const CollisionMesh a(placements.a), b(placements.b);
  ccd::MeshQueries queries;
  const std::size_t count = placements.poses.size();
  const auto ask_all = [&](const std::string& question, MeshQuestion query, const auto& answer) {
    Costs boxes{question, "tests of boxes", std::vector<double>(count), 0};
    Costs triangles{question, "tests of triangles", std::vector<double>(count), 0};
    Costs exact{question, "tests in whole numbers", std::vector<double>(count), 0};
    const Contest ask = [&](std::size_t first, std::size_t last, std::vector<double>& answers) {
      for (std::size_t i = first; i < last; ++i) {
        ccd::MeshCost cost;
        answers[i] = answer(PosedMesh{a, Pose{}}, PosedMesh{b, placements.poses[i]}, cost);
        boxes.work[i] = static_cast<double>(cost.box_tests);
        triangles.work[i] = static_cast<double>(cost.triangle_tests);
        exact.work[i] = static_cast<double>(cost.exact_tests);
      }
    };
    std::vector<double> answers(count);
    ask(0, count, answers);
    const auto yes = static_cast<std::size_t>(
        std::count_if(answers.begin(), answers.end(), [](double x) { return x > 0.0; }));
    boxes.yes = triangles.yes = exact.yes = yes;
    std::vector<Racer> racers{{"kairos", ask}};
    if (query != nullptr) {
      racers = beside_peers(racers.front(), query, placements);
    }
    add_times(question, racers, count, 1);
    add(std::move(boxes));
    add(std::move(triangles));
    add(std::move(exact));
  };
  ask_all("do two tori touch?", &ShapePeer::first_contact,
          [&](const PosedMesh& x, const PosedMesh& y, ccd::MeshCost& cost) {
            const ccd::MeshContact contact = queries.collide(x, y);
            cost = contact.cost;
            return contact.verdict == ccd::MeshVerdict::touching ? 1.0 : 0.0;
          });
  ask_all("which triangles of two tori touch?", &ShapePeer::all_contacts,
          [&](const PosedMesh& x, const PosedMesh& y, ccd::MeshCost& cost) {
            return static_cast<double>(queries.touching_pairs(x, y, &cost).size());
          });
  ask_all("how far apart are two tori?", &ShapePeer::mesh_distances,
          [&](const PosedMesh& x, const PosedMesh& y, ccd::MeshCost& cost) {
            const ccd::MeshDistance distance = queries.distance(x, y);
            cost = distance.cost;
            return distance.upper > 0.0 ? 0.0 : 1.0;
          });
  ask_all("are two tori within 0.05 m?", nullptr,
          [&](const PosedMesh& x, const PosedMesh& y, ccd::MeshCost& cost) {
            const ccd::MeshWithin within = queries.within(x, y, 0.05);
            cost = within.distance.cost;
            return within.verdict == ccd::WithinVerdict::within ? 1.0 : 0.0;
          });
}

void Survey::large_mesh() {
  constexpr std::size_t flights = 64;
  MeshData data = bumpy_sphere_mesh(132, 264, 0.1);
  const std::string question =
      fmt::format("when do two meshes of {} triangles meet, to 1e-9?", data.triangles.size());
  const Shape shape = Mesh{solid_body(std::move(data)).body};
  const auto detector = find_detector("certified");
  Costs costs{question, "looks, certified", {}, 0};
  for (const MotionPair& pair : random_flights(flights)) {
    const TimeOfImpact toi =
        detector->time_of_impact({shape, pair.a}, {shape, pair.b}, {{}, 1.0}, 1e-9);
    costs.work.push_back(toi.evaluations);
    costs.yes += toi.status == ToiStatus::separated ? 0 : 1;
  }
  add(std::move(costs));
}

void Survey::linear() {
  using enum reference::LinearFamily;
  for (const ccd::LinearKind kind : {ccd::LinearKind::vertex_face, ccd::LinearKind::edge_edge}) {
    const std::string what = kind == ccd::LinearKind::vertex_face
                                 ? "do a vertex and a face on straight lines meet?"
                                 : "do two edges on straight lines meet?";
    for (const auto& [name, family] :
         {std::pair{"near each other", close}, std::pair{"on a grid", grid},
          std::pair{"touching to a rounding", touch_ulp}}) {
      reference::LinearFamilies source(family, kind, seed);
      std::array<std::size_t, ccd::linear_stage_names.size()> decided{};
      const std::size_t count = 16 * pairs_;
      for (std::size_t i = 0; i < count; ++i) {
        ++decided[static_cast<std::size_t>(ccd::linear_impact(source.next()).stage)];
      }
      for (std::size_t k = 0; k < decided.size(); ++k) {
        stages_.rows.push_back({fmt::format("{} {}", what, name),
                                std::string(ccd::linear_stage_names[k]),
                                static_cast<std::int64_t>(count),
                                static_cast<double>(decided[k]) / static_cast<double>(count)});
      }
      asked_ += count;
    }
  }
}

/// A square sheet of side 3 m, its vertices `n` + 1 to a side.
MeshData sheet(int n, double height) {
  MeshData data;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      data.vertices.emplace_back(3.0 * i / n - 1.5, height, 3.0 * j / n - 1.5);
    }
  }
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(i * (n + 1) + j); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      data.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      data.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return data;
}

/// A sheet of 20,000 triangles sinks over a ball, waving, a hundred steps.
void Survey::cloth() {
  constexpr int steps = 100;
  ccd::DeformingMesh cloth(sheet(100, 1.1));
  const ccd::DeformingMesh ball(icosphere_mesh(4));
  ccd::DeformingPair from_front(cloth, ball), from_roots(cloth, ball, {.keeps_front = false});
  ccd::DeformingPair self(cloth);
  const std::string question = "what of a sheet of 20000 triangles meets a ball of 5120 in a step?";
  Costs front{question, "tests of boxes, from the last front", {}, 0};
  Costs roots{question, "tests of boxes, from the roots", {}, 0};
  Costs exact{question, "vertices and faces, edges and edges", {}, 0};
  Costs itself{
      "what of a sheet of 20000 triangles meets itself in a step?", "tests of boxes", {}, 0};
  const auto queries = [](const ccd::DeformingPair& pair) {
    double sum = 0.0;
    for (const std::int64_t n : pair.cost().queries_by_stage) {
      sum += static_cast<double>(n);
    }
    return sum;
  };
  const std::vector<Vector3> flat = cloth.end();
  for (int step = 1; step <= steps; ++step) {
    const double phase = 2.0 * std::numbers::pi * step / steps;
    std::vector<Vector3> to = flat;
    for (Vector3& p : to) {
      const double r = std::hypot(p.x(), p.z());
      p.y() += 0.02 * std::sin(6.0 * r - 4.0 * phase) - 0.01 * step * (0.3 + 0.2 * r);
    }
    cloth.move_to(to);
    const bool meets = !from_front.meetings().empty();
    (void)from_roots.meetings();
    const bool folds = !self.meetings().empty();
    front.work.push_back(static_cast<double>(from_front.cost().box_tests));
    roots.work.push_back(static_cast<double>(from_roots.cost().box_tests));
    exact.work.push_back(queries(from_front));
    itself.work.push_back(static_cast<double>(self.cost().box_tests));
    for (Costs* costs : {&front, &roots, &exact}) {
      costs->yes += meets ? 1 : 0;
    }
    itself.yes += folds ? 1 : 0;
  }
  for (Costs* costs : {&front, &roots, &exact, &itself}) {
    add(std::move(*costs));
  }
}

void Survey::crowd() {
  constexpr std::size_t count = 1000;
  constexpr int frames = 60;
  ccd::CollisionWorld world(count);
  DriftingHulls hulls(count);
  for (std::size_t i = 0; i < count; ++i) {
    world.put(i, hulls.shapes[i], hulls.poses[i]);
  }
  const std::string question = "which of 1000 hulls overlap in a frame?";
  Costs near{question, "pairs whose boxes overlap", {}, 0};
  Costs reminded{question, "of them apart along the last frame's direction", {}, 0};
  Costs asked{question, "of them asked anew", {}, 0};
  for (int frame = 0; frame < frames; ++frame) {
    for (std::size_t i = 0; i < count; ++i) {
      world.move(i, hulls.poses[i]);
    }
    const bool some = !world.touching().empty();
    near.work.push_back(static_cast<double>(world.cost().near));
    reminded.work.push_back(static_cast<double>(world.cost().reminded));
    asked.work.push_back(static_cast<double>(world.cost().asked));
    for (Costs* costs : {&near, &reminded, &asked}) {
      costs->yes += some ? 1 : 0;
    }
    hulls.drift();
  }
  for (Costs* costs : {&near, &reminded, &asked}) {
    add(std::move(*costs));
  }
}

ProgramOutput Survey::output() && {
  ProgramOutput output;
  output.tables.emplace_back("systems", reviewed_systems());
  output.tables.emplace_back("costs", std::move(costs_));
  output.tables.emplace_back("stages", std::move(stages_));
  output.shown = {"systems", "costs", "stages"};
  output.timings = std::move(timings_);
  output.runs = asked_;
  return output;
}

}  // namespace

ProgramOutput run_queries(const ExperimentSpec& spec, Size size, std::size_t /*threads*/) {
  Survey survey(size);
  constexpr std::array parts{&Survey::boxes, &Survey::hulls,      &Survey::cylinders,
                             &Survey::tori,  &Survey::large_mesh, &Survey::linear,
                             &Survey::cloth, &Survey::crowd};
  ProgressBar bar(spec.name, parts.size());
  for (const auto part : parts) {
    (survey.*part)();
    bar.advance();
  }
  return std::move(survey).output();
}

}  // namespace kairos::experiments
