#include "core/reading/frame_reader.hpp"
#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/run_options.hpp"
#include "experiments/data_folders.hpp"
#include "experiments/sweeps/experiment.hpp"
#include "experiments/tradeoff/tradeoff_experiment.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

namespace kairos::experiments {
namespace {

struct TradeoffCommand {
  SceneOptions scene;
  std::optional<std::string> duration;
  std::string out;
  bool force = false;
  std::size_t threads = 0;
  int rounds = 3;

  void run() const;
};

std::string number(bool known, double x) {
  return known && std::isfinite(x) ? fmt::format("{:.2e}", x) : "-";
}

void print(const Assessment& assessment) {
  const Reference& reference = assessment.reference;
  fmt::print("{}: {}; reference: {}, itself uncertain by {:.1e} m and {:.1e} s\n", assessment.scene,
             reference.sentence, reference.kind, reference.position_uncertainty,
             reference.time_uncertainty);
  fmt::print("{:<44}{:>12}{:>11}{:>11}{:>8}{:>11}{:>11}  {}\n", "method", "work", "end / m",
             "impact / s", "missed", "depth / m", "energy", "");
  const auto front = pareto_front(assessment, &Errors::position);
  for (std::size_t i = 0; i < assessment.methods.size(); ++i) {
    const auto& [candidate, run, errors] = assessment.methods[i];
    const bool whole = run.completed();
    fmt::print("{:<44}{:>12}{:>11}{:>11}{:>8}{:>11}{:>11}  {}\n", candidate.name, run.work(),
               number(whole, errors.position), number(whole, errors.event_time),
               whole ? fmt::format("{}", errors.missed) : "-", number(whole, errors.penetration),
               number(whole, errors.energy),
               !whole     ? run.status + ": " + run.reason
               : front[i] ? "front"
                          : "");
  }
  fmt::print(
      "work: right-hand sides + overlap tests + gap evaluations + contact solves; front: nothing "
      "is both "
      "cheaper and nearer at the end\n");
}

void TradeoffCommand::run() const {
  const Model model(scene.scene());
  const double length =
      duration ? parse_duration(*duration, {"", 0, "--duration"}) : model.scene().duration;
  const Assessment assessment = assess(model, length, threads);
  print(assessment);
  if (out.empty()) {
    return;
  }
  ExperimentSpec spec = read_experiment(find_experiment("tradeoff"), Size::quick);
  spec.scenes = {assessment.scene};
  const std::string command =
      fmt::format("kairos tradeoff {}{} --out DIR", scene.arguments(),
                  duration ? " --duration " + shell_word(*duration) : std::string());
  const ExperimentOutcome outcome =
      publish_program(spec, {.command = command, .force = force},
                      tradeoff_output({assessment}, timing_table(model, assessment, rounds)), out);
  if (!outcome.figure_problem.empty()) {
    fmt::print(stderr, "tradeoff: {}\n", outcome.figure_problem);
  }
}

}  // namespace

void add_tradeoff_command(Command& app) {
  const auto command = std::make_shared<TradeoffCommand>();
  Command tradeoff = app.add_subcommand(
      "tradeoff", "What accuracy costs on a scene: every sensible method, its errors and its work");
  command->scene.add_to(tradeoff);
  tradeoff.add_option("--duration", command->duration, "how long, s or with a unit").type_name("T");
  tradeoff.add_option("--out", command->out, "folder for tables, measured times and figures")
      .type_name("DIR")
      .check(some_path());
  tradeoff.add_flag("--force", command->force,
                    "replace files in that folder that no experiment has written");
  tradeoff.add_option("--rounds", command->rounds, "with --out: how often each method is timed")
      .check(whole_number(1, 100))
      .capture_default_str();
  tradeoff.add_option("--threads", command->threads, "0: one per core; results do not depend on it")
      .check(whole_number(0, 1024))
      .capture_default_str();
  tradeoff.callback([command] { command->run(); });
}

}  // namespace kairos::experiments
