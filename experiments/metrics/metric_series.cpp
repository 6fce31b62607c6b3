#include "experiments/metrics/metric_series.hpp"

namespace kairos::experiments {

void SeriesRecorder::frame(const Frame& frame) {
  // A frame is kept when it is the first one past the next of evenly spaced instants.
  const double due = static_cast<double>(samples_.size()) * interval_;
  if (frame.time.seconds < due) {
    return;
  }
  Sample sample;
  sample.time = frame.time.seconds;
  sample.frame = frame.index;
  sample.kinetic = frame.ledger.kinetic();
  sample.potential = frame.ledger.potential();
  sample.gain = frame.ledger.energy() - frame.ledger.initial_energy();
  for (std::size_t i = 0; i < energy_line_count; ++i) {
    sample.lines[i] = frame.ledger.line(static_cast<EnergyLine>(i));
  }
  sample.unexplained = frame.ledger.unexplained();
  samples_.push_back(sample);
}

}  // namespace kairos::experiments
