#pragma once

#include "core/recorder.hpp"
#include "experiments/output/csv_row.hpp"
#include "experiments/output/output_folder.hpp"

#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace kairos::experiments {

/// Writes a run while it goes on, in constant memory:
///   trajectory.csv  every body in every drawn frame: pose and velocities, world frame, SI units
///   events.csv      every event, with its contact and the states before and after
///   energy.csv      the energy ledger at every drawn frame, J
class RunFiles : public Recorder {
 public:
  RunFiles(AtomicFile& trajectory, AtomicFile& events, AtomicFile& energy)
      : trajectory_(trajectory), events_(events), energy_(energy) {}

  static constexpr std::array<std::string_view, 3> names{"trajectory.csv", "events.csv",
                                                         "energy.csv"};

  /// What an earlier run of these had written, in this order: they begin with that. A checkpoint
  /// keeps the files of its run beside the world, not in it, so that neither is ever in memory.
  void go_on_from(std::vector<FilePart> begun) { begun_ = std::move(begun); }

  void begin(const Model& model) override;
  void frame(const Frame& frame) override;
  void event(const Event& event) override;
  bool persist(Archive& archive) override;

 private:
  void write_energy(const Frame& frame);

  AtomicFile& trajectory_;
  AtomicFile& events_;
  AtomicFile& energy_;
  std::vector<FilePart> begun_;
  CsvRow row_;
  const Model* model_ = nullptr;
};

/// What the folder of a run looks like: `summary.json` seals it.
[[nodiscard]] OutputSet run_output(bool replace);

}  // namespace kairos::experiments
