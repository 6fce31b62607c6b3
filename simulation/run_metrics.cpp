#include "simulation/run_metrics.hpp"

#include "core/archive.hpp"

#include <algorithm>
#include <cmath>

namespace kairos {
inline namespace simulation {

double energy_error(const EnergyLedger& ledger) {
  CompensatedSum error;
  error.add(ledger.unexplained());
  for (const EnergyLine line :
       {EnergyLine::truncation, EnergyLine::late_impact, EnergyLine::position_correction,
        EnergyLine::roundoff, EnergyLine::projection}) {
    error.add(ledger.line(line));
  }
  return error.value();
}

void RunMetrics::persist(Archive& archive) {
  archive(in_frames, in_impacts, time_overlapping, frames_overlapping, frames, final_energy_error,
          max_energy_error, energy_scale);
}

void RunMetrics::Deepest::look(double found, BodyPair of, Instant t) {
  if (found > depth) {
    depth = found;
    pair = of;
    time = t.seconds;
  }
}

void RunMetrics::Deepest::persist(Archive& archive) {
  bool any = pair.has_value();
  BodyPair of = pair.value_or(BodyPair{});
  archive(depth, any, of.first, of.second, time);
  pair = any ? std::optional(of) : std::nullopt;
}

bool MetricsRecorder::persist(Archive& archive) {
  archive(metrics_, overlapping_, shown_since_);
  constexpr std::int64_t most = std::int64_t{1} << 62;
  archive.require(metrics_.frames >= 0 && metrics_.frames < most &&
                  metrics_.frames_overlapping >= 0 && metrics_.frames_overlapping < most);
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
    metrics_.in_frames.look(deepest->depth, deepest->pair, frame.time);
  }

  metrics_.energy_scale = std::max(
      {metrics_.energy_scale, frame.ledger.kinetic(), std::abs(frame.ledger.initial_energy())});
  metrics_.final_energy_error = energy_error(frame.ledger);
  metrics_.max_energy_error =
      std::max(metrics_.max_energy_error, std::abs(metrics_.final_energy_error));
  ++metrics_.frames;
}

void MetricsRecorder::event(const Event& event) {
  if (event.kind == EventKind::impact) {
    metrics_.in_impacts.look(
        probe_->depth(event.a, event.before_a.pose, event.b, event.before_b.pose),
        {event.a, event.b}, event.time);
  }
}

}  // namespace simulation
}  // namespace kairos
