#pragma once

#include "core/scheme.hpp"
#include "experiments/metrics/metric_apex.hpp"
#include "experiments/metrics/metric_between.hpp"
#include "experiments/metrics/metric_crossing.hpp"
#include "experiments/metrics/metric_impacts.hpp"
#include "experiments/metrics/metric_joints.hpp"
#include "experiments/metrics/metrics.hpp"
#include "simulation/run_metrics.hpp"

#include <vector>

namespace kairos::experiments {

/// What metrics are computed from; watches that nobody asked for are null.
struct Observation {
  const RunResult& result;
  const RunMetrics* frames;
  const BetweenWatch* between;
  const CrossingWatch* crossing;
  const JointWatch* joints;
  const ApexWatch& apex;
  const ImpactWatch& impacts;
  const BodyState& subject;
  const BodyState* exact;  ///< null: there is none, or nobody asked
};

/// What must be watched for a metric.
enum class Needs { nothing, frames, between, crossing, joints, apex, exact };

struct Metric {
  MetricInfo info;
  /// NaN: it has no meaning in this run.
  double (*value)(const Observation&);
  Needs needs = Needs::nothing;
};

/// All metrics, in the order in which they are listed.
[[nodiscard]] const std::vector<Metric>& metric_table();

}  // namespace kairos::experiments
