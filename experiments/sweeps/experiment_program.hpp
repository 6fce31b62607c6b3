#pragma once

#include "experiments/output/table.hpp"
#include "experiments/sweeps/sweep_spec.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kairos::experiments {

/// What an experiment that is no sweep has made.
struct ProgramOutput {
  /// By name: `NAME.csv`. The same bytes each time.
  std::vector<std::pair<std::string, Table>> tables;
  /// Names of the tables that the report shows.
  std::vector<std::string> shown;
  Table timings;  ///< measured times: the one table that differs; no columns: none
  std::size_t runs = 0;
  std::size_t failed = 0;  ///< refused, stopped or failed
};

/// An experiment that a spec names (`program = "..."`) where sweeping one scene is not enough.
struct ExperimentProgram {
  std::string_view name;
  ProgramOutput (*run)(const ExperimentSpec& spec, Size size, std::size_t threads) = nullptr;
};

}  // namespace kairos::experiments
