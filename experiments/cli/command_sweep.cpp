#include "experiments/cli/commands.hpp"
#include "experiments/cli/experiment_options.hpp"
#include "experiments/sweeps/sweep.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>

namespace kairos::experiments {
namespace {

struct SweepCommand {
  std::string spec;
  std::string out;
  SizeOptions size;

  void run() const;
  void print_summaries(const ExperimentSpec& experiment) const;
};

/// Without a folder: the rows of all runs, on stdout.
void SweepCommand::print_summaries(const ExperimentSpec& experiment) const {
  for (const SweepSpec& sweep : experiment.sweeps) {
    fmt::print("{}", run_sweep(sweep, size.threads).runs.csv());
  }
}

void SweepCommand::run() const {
  const ExperimentSpec experiment = read_experiment(spec, size.size());
  if (out.empty()) {
    print_summaries(experiment);
    return;
  }
  const std::string command =
      fmt::format("kairos sweep {} --{} --out DIR", spec, to_string(size.size()));
  run_and_tell(experiment, {size.size(), size.threads, command}, out);
}

}  // namespace

void add_sweep_command(CLI::App& app) {
  const auto command = std::make_shared<SweepCommand>();
  CLI::App* sweep = app.add_subcommand(
      "sweep", "Run a spec of your own: a scene, axes, methods, metrics (experiments/README.md)");
  sweep->add_option("spec", command->spec, "sweep spec (TOML)")->required()->type_name("SPEC.toml");
  sweep
      ->add_option("--out", command->out,
                   "folder for tables and figures; without it the table of runs goes to stdout")
      ->type_name("DIR");
  command->size.add_to(*sweep);
  sweep->callback([command] { command->run(); });
}

}  // namespace kairos::experiments
