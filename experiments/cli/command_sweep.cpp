#include "core/error.hpp"
#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/experiment_options.hpp"
#include "experiments/data_folders.hpp"
#include "experiments/sweeps/sweep.hpp"
#include "experiments/sweeps/sweep_progress.hpp"
#include "experiments/sweeps/sweep_shards.hpp"
#include "simulation/scene_library.hpp"

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
  std::string shard;
  std::vector<std::string> merged;
  std::vector<std::string> watched;
  SizeOptions size;

  void run() const;
  void merge() const;
  void run_part(const ExperimentSpec& experiment) const;
  void tell_progress(const ExperimentSpec& experiment) const;
  void need_out(const char* option) const;
  void refuse_names() const;
  void print_summaries(const ExperimentSpec& experiment) const;
};

/// Prints the rows of all runs on stdout, for a sweep without a folder.
void SweepCommand::print_summaries(const ExperimentSpec& experiment) const {
  for (const SweepSpec& sweep : experiment.sweeps) {
    fmt::print("{}", run_sweep(sweep, size.threads).runs.csv());
  }
}

void SweepCommand::need_out(const char* option) const {
  if (out.empty()) {
    throw InputError("", 0, "--out", fmt::format("is missing; {} needs a folder", option));
  }
}

void SweepCommand::merge() const {
  need_out("--merge");
  if (!spec.empty() || !shard.empty()) {
    throw InputError("", 0, "--merge", "needs folders of shards alone: they know their spec");
  }
  const ExperimentOutcome outcome = merge_shards(merged, size.force, out);
  fmt::print("{} runs merged in {:.1f} s, figures in {:.1f} s -> {}\n", outcome.runs,
             outcome.run_seconds, outcome.figure_seconds, out);
  if (!outcome.figure_problem.empty()) {
    fmt::print(stderr, "{}\n", outcome.figure_problem);
  }
}

void SweepCommand::run_part(const ExperimentSpec& experiment) const {
  need_out("--shard");
  const ExperimentOutcome outcome =
      run_shard(experiment, {size.size(), size.threads, {}, size.force}, parse_shard(shard), out);
  fmt::print("{}: shard {}, {} runs in {:.1f} s -> {}\n", experiment.name, shard, outcome.runs,
             outcome.run_seconds, out);
}

void SweepCommand::tell_progress(const ExperimentSpec& experiment) const {
  const SweepProgress progress = progress_of(experiment, watched);
  fmt::print("{}: {} shards finished, {} begun; {} of {} runs, {:.1f} %\n", experiment.name,
             progress.finished, progress.begun, progress.rows, progress.runs,
             100.0 * static_cast<double>(progress.rows) / static_cast<double>(progress.runs));
}

/// Refuses names: another command runs the experiments that they name.
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
  if (!merged.empty()) {
    merge();
    return;
  }
  if (spec.empty()) {
    throw InputError("", 0, "SPEC.toml", "is missing; needed: a spec, or --merge and folders");
  }
  refuse_names();
  const ExperimentSpec experiment = read_experiment(spec, size.size());
  if (!watched.empty()) {
    tell_progress(experiment);
    return;
  }
  if (!shard.empty()) {
    run_part(experiment);
    return;
  }
  if (out.empty()) {
    print_summaries(experiment);
    return;
  }
  const std::string command =
      fmt::format("kairos sweep {} --{} --out DIR", spec, to_string(size.size()));
  run_and_tell(experiment, {size.size(), size.threads, command, size.force}, out);
}

}  // namespace

void add_sweep_command(Command& app) {
  const auto command = std::make_shared<SweepCommand>();
  Command sweep = app.add_subcommand(
      "sweep", "Run a spec of your own: a scene, axes, methods, metrics (experiments/README.md)");
  sweep.add_option("spec", command->spec, "sweep spec (TOML)").type_name("SPEC.toml");
  sweep
      .add_option("--out", command->out,
                  "folder for tables and figures; without it the table of runs goes to stdout")
      .type_name("DIR")
      .check(some_path());
  sweep
      .add_option(
          "--shard", command->shard,
          "run part I of N alone, into a folder of its own; killed, it goes on where it was")
      .type_name("I/N");
  sweep
      .add_option(
          "--merge", command->merged,
          "make the tables of one machine of all shards: their folders, or a folder of these")
      .type_name("DIR...");
  sweep
      .add_option("--progress", command->watched,
                  "tell how far all shards of the spec are: their folders, or a folder of these")
      .type_name("DIR...");
  sweep.footer(
      "On clusters: share/kairos/clusters has scripts for Slurm arrays and GNU parallel;\n"
      "kairos.sweep(spec, client=...) of the Python package hands shards to Dask.");
  command->size.add_to(sweep);
  sweep.callback([command] { command->run(); });
}

}  // namespace kairos::experiments
