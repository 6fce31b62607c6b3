#pragma once

#include "core/recorder.hpp"
#include "simulation/output/csv_row.hpp"

#include <functional>
#include <string_view>
#include <utility>

namespace kairos {
inline namespace simulation {

/// A run as three CSV tables, row by row while it goes on, in constant memory:
///   trajectory  every body in every drawn frame: pose and velocities, world frame, SI units
///   events      every event, with its contact and the states before and after
///   energy      the energy ledger at every drawn frame, J
class RunTables : public Recorder {
 public:
  /// Where the lines of each go, the header first.
  using Sink = std::function<void(std::string_view)>;
  struct Sinks {
    Sink trajectory;
    Sink events;
    Sink energy;
  };

  explicit RunTables(Sinks sinks) : sinks_(std::move(sinks)) {}

  void begin(const Model& model) override;
  void frame(const Frame& frame) override;
  void event(const Event& event) override;

 private:
  void write_energy(const Frame& frame);

  Sinks sinks_;
  CsvRow row_;
  const Model* model_ = nullptr;
};

}  // namespace simulation
}  // namespace kairos
