#pragma once

#include "core/model.hpp"
#include "simulation/run_metrics.hpp"
#include "simulation/simulate.hpp"

#include <string>

namespace kairos::experiments {

/// A run that is over, and what it was.
struct FinishedRun {
  const Model& model;
  const RunChoice& choice;
  const RunResult& result;
  const RunMetrics& metrics;
};

/// `summary.json`: scene, method, versions, outcome, metrics, energy and counted cost. No timings:
/// the same run gives the same bytes.
[[nodiscard]] std::string summary_json(const FinishedRun& run);
/// A short table for a person.
[[nodiscard]] std::string summary_text(const FinishedRun& run);

}  // namespace kairos::experiments
