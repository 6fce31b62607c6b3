#pragma once

#include "experiments/cli/command_line.hpp"
#include "experiments/sweeps/experiment.hpp"

#include <string>

namespace kairos::experiments {

/// The options that `sweep`, `experiment` and `reproduce` share.
struct SizeOptions {
  bool quick = false;
  bool full = false;
  std::size_t threads = 0;
  bool force = false;  ///< whatever the folder holds is replaced

  void add_to(Command& command);
  [[nodiscard]] Size size() const { return full ? Size::full : Size::quick; }
};

/// Runs an experiment and says on stdout what it made and how it went.
ExperimentOutcome run_and_tell(const ExperimentSpec& spec, const ExperimentOptions& options,
                               const std::string& folder);

}  // namespace kairos::experiments
