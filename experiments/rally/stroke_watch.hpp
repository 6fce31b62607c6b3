#pragma once

#include "core/contact_detector.hpp"
#include "experiments/metrics/metric_crossing.hpp"
#include "experiments/rally/recording.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace kairos::experiments {

/// What became of one stroke, judged by the drawn frames alone.
struct StrokeOutcome {
  int hits = 0;               ///< impacts of bat and ball
  int penetrating = 0;        ///< frames in which the ball is inside the bat
  int crossings = 0;          ///< how often the ball's centre went through the bat's face
  double depth = 0.0;         ///< deepest, m
  std::vector<double> jumps;  ///< how far each hit moved the ball at once, m
  std::vector<double> kicks;  ///< |v' - v| of each hit, m/s

  [[nodiscard]] bool passed() const { return crossings > 0; }
};

/// What collisions took for the bat's speed in a frame, beside the true one; m/s.
struct SpeedReading {
  double told = 0.0;
  double truth = 0.0;
};

/// Watches bat and ball of a rally stroke by stroke. While the ball is in the hand nothing counts.
class StrokeWatch : public Recorder {
 public:
  explicit StrokeWatch(const RallyRecording& rally);
  void begin(const Model& model) override;
  void frame(const Frame& frame) override;
  void event(const Event& event) override;

  /// One per stroke of the recording.
  [[nodiscard]] const std::vector<StrokeOutcome>& strokes() const { return strokes_; }
  [[nodiscard]] const std::vector<SpeedReading>& speeds() const { return speeds_; }

 private:
  /// nullptr before the first stroke and after the last.
  [[nodiscard]] StrokeOutcome* stroke_at(Instant t);
  void look(const Frame& frame, StrokeOutcome& stroke);

  const RallyRecording& rally_;
  const Model* model_ = nullptr;
  BodyIndex bat_ = 0;
  BodyIndex ball_ = 0;
  std::shared_ptr<const ContactDetector> detector_;
  std::optional<CrossingWatch> crossing_;
  std::int64_t crossed_ = 0;
  std::vector<StrokeOutcome> strokes_;
  std::vector<SpeedReading> speeds_;
};

}  // namespace kairos::experiments
