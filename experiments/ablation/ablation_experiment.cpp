#include "experiments/ablation/ablation_experiment.hpp"

#include "core/reading/scene_reader.hpp"
#include "experiments/realtime/realtime_experiment.hpp"
#include "experiments/tradeoff/measured_run.hpp"
#include "simulation/scene_library.hpp"

#include <algorithm>

namespace kairos::experiments {
namespace {

/// A pad, a floor and balls: a field does nothing to walls.
constexpr std::string_view pads = R"(name = "pads"
summary = "pads, walls, balls"
duration = 2.0
G = 9.8
)";

std::string pad_scene() {
  std::string text(pads);
  text += "[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\n";
  for (int k = 0; k < 6; ++k) {
    const std::string x = std::to_string(3.0 * k);
    const std::string n = std::to_string(k);
    text += "[[body]]\nname = \"pad" + n +
            "\"\nentity = \"anti-gravity-pad\"\nhalf_extents = [1.0, " + "0.5, 1.0]\nposition = [" +
            x + ", 0.5, 0.0]\n" + "[[body]]\nname = \"ball" + n +
            "\"\nentity = \"ball\"\nradius = 0.1\nmass = 1.0\nposition = [" + x + ", " +
            std::to_string(1.6 + 0.1 * k) + ", 0.0]\n";
  }
  return text;
}

double difference(const State& x, const State& y) {
  double worst = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    worst = std::max(worst, (x[i].pose.position - y[i].pose.position).norm());
  }
  return worst;
}

}  // namespace

std::vector<Ablation> ablations() {
  // Roundoff, grown by a few impacts of round bodies.
  constexpr double roundoff = 1e-9;
  std::vector<Ablation> all;
  const auto shipped = [&](const char* saving, const char* name, ModelOptions without,
                           RunChoice choice, double tolerance) {
    all.push_back(
        {saving, name, read_scene(find_scene(name)), without, std::move(choice), tolerance});
  };
  const auto off = [](bool ModelOptions::*saving) {
    ModelOptions options;
    options.*saving = false;
    return options;
  };
  ModelOptions every_pair;
  every_pair.broad_phase = "all-pairs";
  RunChoice integrated;
  integrated.method.integrator = "rk4";
  integrated.duration = 0.5;
  shipped("orientation left out", "billiard", off(&ModelOptions::leave_out_orientation), integrated,
          roundoff);
  shipped("closed form instead of an ODE", "bounce", off(&ModelOptions::closed_form), {}, roundoff);
  shipped("closed form instead of an ODE", "cradle", off(&ModelOptions::closed_form), {}, roundoff);
  shipped("pairs that cannot meet are not tested", "billiard", off(&ModelOptions::prune_pairs),
          {.duration = 0.5}, 0.0);
  all.push_back({"fields act on what moves freely only",
                 "pads",
                 parse_scene(pad_scene(), "pads.toml"),
                 off(&ModelOptions::prune_pairs),
                 {},
                 0.0});
  all.push_back({"what is out of reach is not tested",
                 "256 balls in a box",
                 parse_scene(gas_scene(256), "gas.toml"),
                 every_pair,
                 {.duration = 0.25},
                 roundoff});
  return all;
}

Ablated ablate(const Ablation& ablation) {
  const MeasuredRun with = measure(Model(ablation.made), ablation.choice);
  const MeasuredRun without = measure(Model(ablation.made, ablation.without), ablation.choice);
  return {with.cost, without.cost, difference(with.end, without.end)};
}

ProgramOutput run_ablation(const ExperimentSpec& /*spec*/, Size /*size*/, std::size_t /*threads*/) {
  ProgramOutput output;
  Table table{{"saving", "scene", "rhs_with", "rhs_without", "queries_with", "queries_without",
               "evaluations_with", "evaluations_without", "overlap_with", "overlap_without",
               "difference", "allowed"},
              {}};
  Table timings{{"saving", "scene", "seconds_with", "seconds_without"}, {}};
  for (const Ablation& ablation : ablations()) {
    const Ablated r = ablate(ablation);
    output.runs += 2;
    table.rows.push_back({ablation.saving, ablation.scene, r.with.right_hand_sides,
                          r.without.right_hand_sides, r.with.toi_queries, r.without.toi_queries,
                          r.with.toi_evaluations, r.without.toi_evaluations, r.with.overlap_tests,
                          r.without.overlap_tests, number_cell(r.difference),
                          number_cell(ablation.tolerance)});
    const Model model(ablation.made), bare(ablation.made, ablation.without);
    double with = 1e9, without = 1e9;
    for (int round = 0; round < 5; ++round) {  // in turn, the least counts
      with = std::min(with, time_run(model, ablation.choice));
      without = std::min(without, time_run(bare, ablation.choice));
    }
    timings.rows.push_back({ablation.saving, ablation.scene, with, without});
  }
  output.tables.emplace_back("savings", std::move(table));
  output.shown = {"savings"};
  output.timings = std::move(timings);
  return output;
}

}  // namespace kairos::experiments
