#pragma once

#include "core/drive.hpp"

#include <string>
#include <vector>

namespace kairos {
inline namespace core {

/// A recorded pose at a time.
struct TrackSample {
  double time = 0.0;  ///< s
  Pose pose;
  bool closed = false;  ///< the fist, from here to the next sample
};

/// A body that follows a recording. Between two samples it moves on a straight line and turns at a
/// constant rate the shorter way (slerp), so that its velocity jumps at samples; `smooth` takes a
/// cubic Hermite curve for the position, with the derivative of the parabola through each three
/// neighbouring samples, so that velocity is continuous (the rotation stays a slerp). Before the
/// first and after the last sample it holds still. Samples are the knots.
class Track : public Drive {
 public:
  /// How samples become motions.
  struct Options {
    bool smooth = false;
    double reach = 0.0;            ///< m; no point of the body is farther from its origin
    std::string description = {};  ///< where it comes from
    bool gestures = false;         ///< whether `TrackSample::closed` was told
  };

  /// At least one sample, times strictly increasing (asserted: the reader has refused others).
  Track(std::vector<TrackSample> samples, Options options);

  [[nodiscard]] Motion motion(Instant t, double at_most) const override;
  [[nodiscard]] std::string description() const override { return options_.description; }
  /// Not even with `smooth`: where the recording begins and ends, it starts and stops.
  [[nodiscard]] bool smooth() const override { return samples_.size() == 1; }
  [[nodiscard]] bool has_gestures() const override { return options_.gestures; }
  [[nodiscard]] bool closed(Instant t) const override;
  /// As given, by time.
  [[nodiscard]] const std::vector<TrackSample>& samples() const { return samples_; }
  /// Whether the orientation ever changes.
  [[nodiscard]] bool turns() const;

 private:
  /// The curve between samples i and i + 1 from that sample on, made once.
  [[nodiscard]] Motion segment(std::size_t i) const;
  /// Index of the sample whose segment begins at or before t; a remainder of a segment that only
  /// rounding left over belongs to the next. Only for t not before the first sample.
  [[nodiscard]] std::size_t index_at(Instant t) const;

  std::vector<TrackSample> samples_;
  Options options_;
  std::vector<Motion> segments_;
};

}  // namespace core
}  // namespace kairos
