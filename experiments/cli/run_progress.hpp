#pragma once

#include "core/recorder.hpp"

#include <chrono>
#include <cstdint>

namespace kairos::experiments {

/// Shows a person on a terminal how far a run has come: from its start on, simulated time and
/// events a second, so that one sees a run that hardly gets on.
class RunProgress : public Recorder {
 public:
  /// `end`: of the run, s.
  explicit RunProgress(double end) : end_(end) {}
  RunProgress(const RunProgress&) = delete;
  RunProgress& operator=(const RunProgress&) = delete;
  /// Wipes the line.
  ~RunProgress() override;

  void begin(const Model& model) override;
  void frame(const Frame& frame) override;
  void event(const Event& event) override;
  void goes_on(Instant t) override { reach(t); }
  bool persist(Archive& /*archive*/) override { return true; }

 private:
  using Clock = std::chrono::steady_clock;
  void reach(Instant t);
  void draw(double t) const;

  double end_;
  std::int64_t events_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_ = start_;
};

}  // namespace kairos::experiments
