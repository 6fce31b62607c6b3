#pragma once

#include "experiments/sweeps/sweep_table.hpp"

#include <cstddef>
#include <map>
#include <mutex>
#include <string>

namespace kairos::experiments {

/// The rows of a sweep that are finished, in a file that grows by one record a row, so that a sweep
/// that was killed goes on where it stopped. A record is whole (length and checksum) or not there;
/// what a death cut short is run again. Thread-safe.
class SweepJournal {
 public:
  /// `key`: what the rows depend on; a journal of another key is of another sweep and is begun
  /// anew.
  SweepJournal(std::string path, const std::string& key);
  SweepJournal(const SweepJournal&) = delete;
  SweepJournal& operator=(const SweepJournal&) = delete;
  ~SweepJournal();

  /// Rows that an earlier run of this sweep finished, by index.
  [[nodiscard]] std::map<std::size_t, RunRecord>& found() { return found_; }
  /// Adds a finished row. Throws `RunError` where the disk does not take it.
  void add(std::size_t index, RunRecord& record);

 private:
  void load(const std::string& key);
  void append(const std::string& bytes);

  std::string path_;
  int descriptor_ = -1;
  std::mutex mutex_;
  std::map<std::size_t, RunRecord> found_;
};

/// What the rows of a sweep depend on: its plan, the scene's text, and the program itself.
[[nodiscard]] std::string sweep_key(const SweepSpec& spec, const std::vector<PlannedRun>& plan,
                                    const std::string& scene);

}  // namespace kairos::experiments
