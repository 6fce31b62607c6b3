#pragma once

#include "core/checkpoint.hpp"
#include "experiments/checkpoint/checkpoint_file.hpp"

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace kairos::experiments {

/// Keeps the latest checkpoint of a run in a file: the last one that the run offers, and before it
/// one every `interval` seconds of a person's time, so that a run that is killed has lost no more.
/// When they are made does not show in what a run gives.
class FileKeeper : public CheckpointKeeper {
 public:
  /// `files`: of the run, as far as they are written; a checkpoint holds them.
  FileKeeper(std::string path, RunIdentity identity, std::vector<AtomicFile*> files,
             double interval)
      : path_(std::move(path)),
        identity_(std::move(identity)),
        files_(std::move(files)),
        interval_(interval) {}

  [[nodiscard]] bool wants(Instant t, bool last) override;
  void keep(Instant t, std::string_view world) override;
  /// Whether there is a file.
  [[nodiscard]] bool kept() const { return kept_; }

 private:
  using Clock = std::chrono::steady_clock;

  std::string path_;
  RunIdentity identity_;
  std::vector<AtomicFile*> files_;  ///< not owned
  std::chrono::duration<double> interval_;
  Clock::time_point since_ = Clock::now();
  bool kept_ = false;
};

}  // namespace kairos::experiments
