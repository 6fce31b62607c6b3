#include "simulation/run_metrics.hpp"

#include "core/archive.hpp"

#include <algorithm>
#include <cmath>

namespace kairos {
inline namespace simulation {

double energy_error(const EnergyLedger& ledger) {
  CompensatedSum error;
  error.add(ledger.unexplained());
  for (const EnergyLine line : {EnergyLine::truncation, EnergyLine::late_impact,
                                EnergyLine::position_correction, EnergyLine::roundoff}) {
    error.add(ledger.line(line));
  }
  return error.value();
}

void RunMetrics::persist(Archive& archive) {
  bool any = deepest.has_value();
  BodyPair pair = deepest.value_or(BodyPair{});
  archive(max_depth, any, pair.first, pair.second, time_of_max_depth, time_overlapping,
          frames_overlapping, frames, final_energy_error, max_energy_error, energy_scale);
  deepest = any ? std::optional(pair) : std::nullopt;
}

bool MetricsRecorder::persist(Archive& archive) {
  archive(metrics_, overlapping_, shown_since_);
  return true;
}

void MetricsRecorder::begin(const Model& model) {
  probe_.emplace(model);
  metrics_ = {};
  overlapping_ = false;
}

void MetricsRecorder::frame(const Frame& frame) {
  if (overlapping_) {
    metrics_.time_overlapping += frame.time - shown_since_;
  }
  const std::optional<Penetration> deepest = probe_->deepest(frame.bodies, frame.in_hand);
  overlapping_ = deepest.has_value();
  shown_since_ = frame.time;
  if (deepest) {
    ++metrics_.frames_overlapping;
    if (deepest->depth > metrics_.max_depth) {
      metrics_.max_depth = deepest->depth;
      metrics_.deepest = deepest->pair;
      metrics_.time_of_max_depth = frame.time.seconds;
    }
  }

  metrics_.energy_scale = std::max(
      {metrics_.energy_scale, frame.ledger.kinetic(), std::abs(frame.ledger.initial_energy())});
  metrics_.final_energy_error = energy_error(frame.ledger);
  metrics_.max_energy_error =
      std::max(metrics_.max_energy_error, std::abs(metrics_.final_energy_error));
  ++metrics_.frames;
}

}  // namespace simulation
}  // namespace kairos
