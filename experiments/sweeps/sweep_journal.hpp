#pragma once

#include "experiments/output/record_journal.hpp"
#include "experiments/sweeps/sweep_table.hpp"

#include <cstddef>
#include <map>
#include <string>

namespace kairos::experiments {

/// The rows of a sweep that are finished, so that one that was killed goes on where it stopped.
/// Adding is thread-safe.
class SweepJournal {
 public:
  /// `key`: what the rows depend on, see `RecordJournal`.
  SweepJournal(std::string path, const std::string& key);

  /// Rows that an earlier run of this sweep finished, by index.
  [[nodiscard]] std::map<std::size_t, RunRecord>& found() { return found_; }
  /// Adds a finished row. Throws `RunError` where the disk does not take it.
  void add(std::size_t index, RunRecord& record);

 private:
  RecordJournal journal_;
  std::map<std::size_t, RunRecord> found_;
};

/// What the rows of a sweep depend on: its plan, the scene's text, and the program itself.
[[nodiscard]] std::string sweep_key(const SweepSpec& spec, const SweepPlan& plan,
                                    const std::string& scene);

}  // namespace kairos::experiments
