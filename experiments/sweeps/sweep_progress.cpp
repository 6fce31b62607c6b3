#include "experiments/sweeps/sweep_progress.hpp"

#include "core/error.hpp"
#include "experiments/output/record_journal.hpp"
#include "experiments/sweeps/sweep_plan.hpp"

#include <filesystem>
#include <string_view>
#include <system_error>

namespace kairos::experiments {
namespace {

namespace fs = std::filesystem;

/// Adds the shard that lies in a folder, or those in the folders inside it.
void add(const ExperimentSpec& spec, const fs::path& folder, int depth, SweepProgress& progress) {
  std::error_code none;
  bool has_rows = false;
  for (const SweepSpec& sweep : spec.sweeps) {
    const fs::path rows = folder / (sweep.name + ".rows");
    if (fs::is_regular_file(rows, none)) {
      has_rows = true;
      RecordFile(rows.string()).scan([&progress](std::size_t, std::string_view) {
        ++progress.rows;
      });
    }
  }
  if (fs::is_regular_file(folder / "shard.csv", none)) {
    ++progress.finished;
  } else if (has_rows) {
    ++progress.begun;
  } else if (depth > 0) {
    for (const auto& entry : fs::directory_iterator(folder, none)) {
      if (entry.is_directory(none)) {
        add(spec, entry.path(), depth - 1, progress);
      }
    }
  }
}

}  // namespace

SweepProgress progress_of(const ExperimentSpec& spec, const std::vector<std::string>& folders) {
  SweepProgress progress;
  for (const SweepSpec& sweep : spec.sweeps) {
    progress.runs += SweepPlan(sweep).size();
  }
  for (const std::string& folder : folders) {
    std::error_code none;
    if (!fs::is_directory(folder, none)) {
      throw InputError(folder, 0, "--progress", "is no folder; needed: folders of shards");
    }
    add(spec, folder, 2, progress);
  }
  return progress;
}

}  // namespace kairos::experiments
