#pragma once

#include "core/recorder.hpp"
#include "experiments/progress_bar.hpp"

namespace kairos::experiments {

/// Tells a bar how far a run has come: one may take as long as all others.
class WayOfRun : public Recorder {
 public:
  /// `end`: of the run, s.
  WayOfRun(ProgressBar& bar, double end) : bar_(bar), end_(end) {}

  void frame(const Frame& frame) override { bar_.reach_within(frame.time.seconds / end_); }
  void event(const Event& event) override { bar_.reach_within(event.time.seconds / end_); }
  void goes_on(Instant t) override { bar_.reach_within(t.seconds / end_); }

 private:
  ProgressBar& bar_;
  double end_;
};

}  // namespace kairos::experiments
