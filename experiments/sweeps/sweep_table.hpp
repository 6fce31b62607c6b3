#pragma once

#include "experiments/metrics/metric_series.hpp"
#include "experiments/output/table.hpp"
#include "experiments/sweeps/sweep_plan.hpp"

#include <functional>
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

/// Gives the record of a run, by its index in the plan.
using RecordSource = std::function<RunRecord(std::size_t index)>;
/// Takes a row of a table; the first one holds the names of the columns.
using RowSink = std::function<void(const std::vector<Cell>& row)>;

/// Where the tables of a sweep go, row by row. What is empty is not made.
struct SweepSinks {
  RowSink runs;     ///< one row per run in the order of the plan; what failed is a row, too
  RowSink summary;  ///< one row per method and point: quartiles over the repeats
  RowSink series;   ///< energy over time
  RowSink apexes;
  RowSink timings;  ///< seconds per run
};

/// Turns the records of all runs into the rows of the tables. Of the records no more than one is in
/// memory, of the numbers those of one point. Returns how many were refused, stopped or failed.
std::size_t write_sweep_tables(const SweepSpec& spec, const SweepPlan& plan,
                               const RecordSource& records, const SweepSinks& sinks);

}  // namespace kairos::experiments
