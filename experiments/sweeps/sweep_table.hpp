#pragma once

#include "experiments/metrics/metric_series.hpp"
#include "experiments/sweeps/sweep.hpp"
#include "experiments/sweeps/sweep_plan.hpp"

#include <optional>
#include <string>
#include <vector>

namespace kairos::experiments {

/// What one run of a sweep left behind.
struct RunRecord {
  std::string status;  ///< completed, stopped, refused, failed
  std::string reason;
  std::vector<std::optional<double>> metrics;  ///< as `SweepSpec::metrics`; empty: none
  std::vector<SeriesRecorder::Sample> samples;
  std::vector<ApexWatch::Apex> apexes;
  double seconds = 0.0;
};

/// Puts the records of all runs, in the order of the plan, into tables.
[[nodiscard]] SweepResult sweep_tables(const SweepSpec& spec, const SweepPlan& plan,
                                       const std::vector<RunRecord>& records);

}  // namespace kairos::experiments
