#pragma once

#include "experiments/output/record_journal.hpp"
#include "experiments/sweeps/sweep_table.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// The rows of a sweep that are finished, so that one that was killed goes on where it stopped, and
/// so that rows are on the disk and not in memory: eight bytes a run are. Adding is thread-safe.
class SweepJournal {
 public:
  /// `key`: what the rows depend on, see `RecordJournal`. `runs`: of the whole sweep.
  SweepJournal(const std::string& path, const std::string& key, std::size_t runs);

  /// Whether the row of this run is there.
  [[nodiscard]] bool has(std::size_t index) const { return places_[index] != none; }
  /// How many rows are there.
  [[nodiscard]] std::size_t size() const;
  /// Adds a finished row. Throws `RunError` where the disk does not take it.
  void add(std::size_t index, RunRecord& record);
  /// Where rows are in the file, by index; `none`: nowhere.
  [[nodiscard]] const std::vector<std::size_t>& places() const { return places_; }

  static constexpr std::size_t none = static_cast<std::size_t>(-1);

 private:
  std::vector<std::size_t> places_;
  RecordJournal journal_;
};

/// A row as a journal keeps it.
[[nodiscard]] RunRecord read_row(std::string_view bytes, std::size_t& index);

/// What the rows of a sweep depend on: its plan, the scene's text, and the program itself.
[[nodiscard]] std::string sweep_key(const SweepSpec& spec, const SweepPlan& plan,
                                    const std::string& scene);

}  // namespace kairos::experiments
