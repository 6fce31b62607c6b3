#pragma once

#include "experiments/sweeps/experiment.hpp"
#include "experiments/sweeps/sweep.hpp"

#include <string>
#include <vector>

namespace kairos::experiments {

/// "3/8": shard 3 of 8. Throws `InputError`.
[[nodiscard]] Shard parse_shard(const std::string& text);

/// Runs one shard of the sweeps of a spec and leaves its rows in a folder: `NAME.rows` for each
/// sweep, `spec.toml`, and `shard.csv`, which comes last. Killed and started again it goes on where
/// it was; what is finished is left as it is. Throws `InputError`, `RunError`.
ExperimentOutcome run_shard(const ExperimentSpec& spec, const ExperimentOptions& options,
                            const Shard& shard, const std::string& folder);

/// Makes of all shards of a sweep the tables that one machine would have made: the same bytes, but
/// for `timings.csv`. `folders`: of shards, or of folders of shards, in any order. Throws
/// `InputError` that names a shard that is missing, there twice, not finished, or of another spec,
/// scene or build.
ExperimentOutcome merge_shards(const std::vector<std::string>& folders, bool force,
                               const std::string& out);

}  // namespace kairos::experiments
