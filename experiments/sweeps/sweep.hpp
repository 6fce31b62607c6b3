#pragma once

#include "experiments/output/table.hpp"
#include "experiments/sweeps/sweep_spec.hpp"
#include "experiments/sweeps/sweep_table.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace kairos::experiments {

/// The tables of a sweep. All but `timings` are the same bytes for the same spec and machine,
/// whatever the number of threads.
struct SweepResult {
  Table runs, summary, series, apexes, timings;  ///< as `SweepSinks`
  std::size_t failed = 0;                        ///< runs that were refused, stopped or failed
};

/// A part of a sweep: shard `index` of `count`, each the same share of every method's runs.
struct Shard {
  std::size_t index = 1;  ///< from 1
  std::size_t count = 1;

  /// Where shard `k` ends and the next one begins, among the runs of a method.
  [[nodiscard]] std::size_t begin(std::size_t k, std::size_t per_method) const {
    return per_method / count * k + per_method % count * k / count;
  }
  /// Whether a run is of this shard, by its place among the runs of its method.
  [[nodiscard]] bool holds(std::size_t place, std::size_t per_method) const {
    return place >= begin(index - 1, per_method) && place < begin(index, per_method);
  }
};

/// Runs all combinations, and keeps all tables in memory. A run that is refused, stops before its
/// end or fails is a row with its `status` (completed, stopped, refused, failed) and `reason`.
/// Throws `InputError` where the spec itself is wrong: a scene that cannot be read, a method that
/// does not exist, an override that no run accepts. `threads` 0: one per core.
[[nodiscard]] SweepResult run_sweep(const SweepSpec& spec, std::size_t threads);

/// Runs what is missing of a shard, each finished row into a journal of this key; see `run_sweep`.
/// Returns how many rows the shard has.
std::size_t run_rows(const SweepSpec& spec, std::size_t threads, const std::string& journal,
                     const std::string& key, const Shard& shard);

/// A sweep in constant memory: rows go to the journal, from which one that was killed goes on, and
/// from there to the tables. Whoever has the tables removes the journal. Returns how many were
/// refused, stopped or failed.
std::size_t stream_sweep(const SweepSpec& spec, std::size_t threads, const std::string& journal,
                         const SweepSinks& sinks);

/// Sinks that fill the tables of a result.
[[nodiscard]] SweepSinks tables_in(SweepResult& result, bool series);

/// Quantile of sorted values by linear interpolation [Hyndman1996, type 7]; needs one value.
[[nodiscard]] double quantile(const std::vector<double>& sorted, double p);

}  // namespace kairos::experiments
