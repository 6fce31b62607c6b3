#include "experiments/programs/experiment_program.hpp"

#include "experiments/ablation/ablation_experiment.hpp"
#include "experiments/extremes/extremes_experiment.hpp"
#include "experiments/realtime/realtime_experiment.hpp"
#include "experiments/tradeoff/tradeoff_experiment.hpp"

#include <array>

namespace kairos::experiments {

const ExperimentProgram* find_program(std::string_view name) {
  static constexpr std::array<ExperimentProgram, 4> programs{{{"tradeoff", run_tradeoff},
                                                              {"extremes", run_extremes},
                                                              {"real-time", run_realtime},
                                                              {"ablation", run_ablation}}};
  for (const ExperimentProgram& program : programs) {
    if (program.name == name) {
      return &program;
    }
  }
  return nullptr;
}

}  // namespace kairos::experiments
