#pragma once

#include "core/recorder.hpp"
#include "experiments/metrics/metric_apex.hpp"

#include <array>
#include <optional>
#include <vector>

namespace kairos::experiments {

/// Energy over time as the ledger sees it, thinned to at most `samples` + 1 frames, and the apexes.
class SeriesRecorder : public Recorder {
 public:
  struct Sample {
    double time = 0.0;
    std::int64_t frame = 0;
    double kinetic = 0.0;
    double potential = 0.0;
    double gain = 0.0;  ///< energy minus initial energy, J
    std::array<double, energy_line_count> lines{};
    double unexplained = 0.0;
  };

  SeriesRecorder(BodyIndex body, std::int64_t samples, double duration)
      : apex_(body), interval_(duration / static_cast<double>(samples)) {}
  [[nodiscard]] bool wants_motions() const override { return true; }
  void frame(const Frame& frame) override;
  void motion(BodyIndex body, const Motion& motion) override { apex_.motion(body, motion); }
  void event(const Event& event) override { apex_.event(event); }

  [[nodiscard]] const std::vector<Sample>& samples() const { return samples_; }
  [[nodiscard]] const std::vector<ApexWatch::Apex>& apexes() const { return apex_.apexes(); }

 private:
  ApexWatch apex_;
  double interval_;
  std::vector<Sample> samples_;
};

}  // namespace kairos::experiments
