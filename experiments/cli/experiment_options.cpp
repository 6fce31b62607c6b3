#include "experiments/cli/experiment_options.hpp"

#include "experiments/cli/checks.hpp"
#include "experiments/programs/run_experiment.hpp"

#include <fmt/format.h>

namespace kairos::experiments {

void SizeOptions::add_to(Command& command) {
  Argument quick_flag =
      command.add_flag("--quick", quick, "the small size of the spec (the default)");
  command.add_flag("--full", full, "the full size").excludes(quick_flag);
  command.add_flag("--force", force, "replace files that no earlier experiment has written");
  command.add_option("--threads", threads, "0: one per core; results do not depend on it")
      .check(whole_number(0, 1024))
      .capture_default_str();
}

ExperimentOutcome run_and_tell(const ExperimentSpec& spec, const ExperimentOptions& options,
                               const std::string& folder) {
  const ExperimentOutcome outcome = run_experiment(spec, options, folder);
  fmt::print("{}: {} runs in {:.1f} s", spec.name, outcome.runs, outcome.run_seconds);
  if (outcome.failed > 0) {
    fmt::print(" ({} refused, stopped or failed: see the column status)", outcome.failed);
  }
  fmt::print(", figures in {:.1f} s -> {}\n", outcome.figure_seconds, folder);
  if (!outcome.figure_problem.empty()) {
    fmt::print(stderr, "{}: {}\n", spec.name, outcome.figure_problem);
  }
  return outcome;
}

}  // namespace kairos::experiments
