#pragma once

#include "core/recorder.hpp"
#include "experiments/output/csv_row.hpp"
#include "experiments/output/output_folder.hpp"

namespace kairos::experiments {

/// Writes a run while it goes on, in constant memory:
///   trajectory.csv  every body in every drawn frame: pose and velocities, world frame, SI units
///   events.csv      every event, with its contact and the states before and after
///   energy.csv      the energy ledger at every drawn frame, J
class RunFiles : public Recorder {
 public:
  /// The files appear when the folder publishes them.
  explicit RunFiles(OutputFolder& folder);

  void begin(const Model& model) override;
  void frame(const Frame& frame) override;
  void event(const Event& event) override;
  bool persist(Archive& archive) override;

 private:
  void write_energy(const Frame& frame);

  AtomicFile& trajectory_;
  AtomicFile& events_;
  AtomicFile& energy_;
  CsvRow row_;
  const Model* model_ = nullptr;
};

/// Where nobody wants the files of a run that is resumed.
class NoRunFiles : public Recorder {
 public:
  bool persist(Archive& archive) override;
};

}  // namespace kairos::experiments
