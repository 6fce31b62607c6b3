#include "experiments/programs/run_experiment.hpp"

#include "core/error.hpp"
#include "core/nearest_name.hpp"
#include "experiments/ablation/ablation_experiment.hpp"
#include "experiments/extremes/extremes_experiment.hpp"
#include "experiments/gas/gas_experiment.hpp"
#include "experiments/queries/queries_experiment.hpp"
#include "experiments/realtime/realtime_experiment.hpp"
#include "experiments/references/references_experiment.hpp"
#include "experiments/tradeoff/tradeoff_experiment.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <vector>

namespace kairos::experiments {
namespace {

constexpr std::array<ExperimentProgram, 7> programs{{{"tradeoff", run_tradeoff},
                                                     {"extremes", run_extremes},
                                                     {"real-time", run_realtime},
                                                     {"ablation", run_ablation},
                                                     {"contact-truths", run_references},
                                                     {"gas", run_gas},
                                                     {"queries", run_queries}}};

const ExperimentProgram& program_of(const ExperimentSpec& spec) {
  std::vector<std::string_view> names;
  for (const ExperimentProgram& program : programs) {
    if (program.name == spec.program) {
      return program;
    }
    names.push_back(program.name);
  }
  throw InputError(
      spec.path, spec.program_line, "program",
      fmt::format("'{}' is unknown; {}", spec.program, suggestion(spec.program, names)));
}

}  // namespace

ExperimentOutcome run_experiment(const ExperimentSpec& spec, const ExperimentOptions& options,
                                 const std::string& folder) {
  if (spec.program.empty()) {
    return run_sweeps(spec, options, folder);
  }
  const auto start = std::chrono::steady_clock::now();
  const ProgramOutput made = program_of(spec).run(spec, options.size, options.threads);
  ExperimentOutcome outcome = publish_program(spec, options, made, folder);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  outcome.run_seconds = elapsed.count() - outcome.figure_seconds;
  return outcome;
}

}  // namespace kairos::experiments
