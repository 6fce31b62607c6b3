#pragma once

#include "experiments/progress_bar.hpp"
#include "simulation/run_metrics.hpp"
#include "simulation/simulate.hpp"

#include <map>
#include <string>
#include <vector>

namespace kairos::experiments {

/// What a run is compared by.
struct MeasuredRun {
  std::string status;  ///< completed, stopped, refused, too long
  std::string reason;
  State end;                                          ///< bodies at the end
  double reached = 0.0;                               ///< s
  std::map<BodyPair, std::vector<double>> impacts{};  ///< times, s, by pair in the order of time
  RunMetrics metrics{};
  Cost cost{};

  [[nodiscard]] bool completed() const { return status == "completed"; }
  /// Counted work: right-hand sides, overlap tests, gap evaluations and contact solves, each one.
  [[nodiscard]] std::int64_t work() const {
    return cost.right_hand_sides + cost.overlap_tests + cost.toi_evaluations + cost.contact_solves;
  }
};

/// Runs and measures; what cannot run or does not end in `most_calls` frames and events is a
/// status. Frames at which it is looked at are the method's own. `bar` is told how far the run is.
[[nodiscard]] MeasuredRun measure(const Model& model, const RunChoice& choice,
                                  ProgressBar* bar = nullptr);

/// Seconds of one run without any measuring.
[[nodiscard]] double time_run(const Model& model, const RunChoice& choice);

}  // namespace kairos::experiments
