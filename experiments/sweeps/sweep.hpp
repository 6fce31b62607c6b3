#pragma once

#include "experiments/output/table.hpp"
#include "experiments/sweeps/sweep_spec.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace kairos::experiments {

/// The tables of a sweep. All but `timings` are the same bytes for the same spec and machine,
/// whatever the number of threads.
struct SweepResult {
  Table runs;              ///< one row per run in the order of the plan; what failed is a row, too
  Table summary;           ///< one row per method and point: quartiles over the repeats
  Table series;            ///< energy over time, where asked for
  Table apexes;            ///< where asked for
  Table timings;           ///< seconds per run
  std::size_t failed = 0;  ///< runs that were refused, stopped or failed
};

/// Runs all combinations. A run that is refused, stops before its end or fails is a row with its
/// `status` (completed, stopped, refused, failed) and `reason`. Throws `InputError` where the spec
/// itself is wrong: a scene that cannot be read, a method that does not exist, an override that no
/// run accepts. `threads` 0: one per core. `journal`: a file that keeps finished rows, from which
/// a sweep that was killed goes on; whoever has written the tables removes it. Empty: none.
[[nodiscard]] SweepResult run_sweep(const SweepSpec& spec, std::size_t threads,
                                    const std::string& journal = "");

/// Quantile of sorted values by linear interpolation [Hyndman1996, type 7]; needs one value.
[[nodiscard]] double quantile(const std::vector<double>& sorted, double p);

}  // namespace kairos::experiments
