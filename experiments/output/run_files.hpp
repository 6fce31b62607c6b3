#pragma once

#include "experiments/output/output_folder.hpp"
#include "simulation/output/run_tables.hpp"

#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace kairos::experiments {

/// The tables of a run as files, written while it goes on.
class RunFiles : public RunTables {
 public:
  RunFiles(AtomicFile& trajectory, AtomicFile& events, AtomicFile& energy);

  static constexpr std::array<std::string_view, 3> names{"trajectory.csv", "events.csv",
                                                         "energy.csv"};

  /// What an earlier run of these had written, in this order: they begin with that. A checkpoint
  /// keeps the files of its run beside the world, not in it, so that neither is ever in memory.
  void go_on_from(std::vector<FilePart> begun) { begun_ = std::move(begun); }

  bool persist(Archive& archive) override;

 private:
  AtomicFile& trajectory_;
  AtomicFile& events_;
  AtomicFile& energy_;
  std::vector<FilePart> begun_;
};

/// What the folder of a run looks like: `summary.json` seals it.
[[nodiscard]] OutputSet run_output(bool replace);

}  // namespace kairos::experiments
