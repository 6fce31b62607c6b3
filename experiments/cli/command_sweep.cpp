#include "core/error.hpp"
#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/experiment_options.hpp"
#include "experiments/data_folders.hpp"
#include "experiments/sweeps/sweep.hpp"
#include "simulation/scene_library.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace kairos::experiments {
namespace {

struct SweepCommand {
  std::string spec;
  std::string out;
  SizeOptions size;

  void run() const;
  void refuse_names() const;
  void print_summaries(const ExperimentSpec& experiment) const;
};

/// Without a folder: the rows of all runs, on stdout.
void SweepCommand::print_summaries(const ExperimentSpec& experiment) const {
  for (const SweepSpec& sweep : experiment.sweeps) {
    fmt::print("{}", run_sweep(sweep, size.threads).runs.csv());
  }
}

/// A name is no spec; what it names is run by another command.
void SweepCommand::refuse_names() const {
  std::error_code none;
  if (std::filesystem::exists(spec, none)) {
    return;
  }
  const auto is_one_of = [this](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), spec) != names.end();
  };
  const std::string needed = "; needed: the file of a spec (experiments/README.md)";
  if (is_one_of(shipped_scenes())) {
    throw InputError("", 0, spec, fmt::format("is a scene, kairos run {}", spec) + needed);
  }
  if (is_one_of(shipped_experiments())) {
    throw InputError("", 0, spec,
                     fmt::format("is an experiment, kairos experiment {}", spec) + needed);
  }
}

void SweepCommand::run() const {
  refuse_names();
  const ExperimentSpec experiment = read_experiment(spec, size.size());
  if (out.empty()) {
    print_summaries(experiment);
    return;
  }
  const std::string command =
      fmt::format("kairos sweep {} --{} --out DIR", spec, to_string(size.size()));
  run_and_tell(experiment, {size.size(), size.threads, command, size.force}, out);
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
      ->type_name("DIR")
      ->check(some_path());
  command->size.add_to(*sweep);
  sweep->callback([command] { command->run(); });
}

}  // namespace kairos::experiments
