#pragma once

#include "core/archive.hpp"
#include "core/scheme.hpp"

#include <algorithm>

namespace kairos {
inline namespace core {

/// The clock of rendered frames: which one comes next, and whether it is the run's last. Only the
/// last may be cut short, by the end of the run.
class FrameClock {
 public:
  explicit FrameClock(const SchemeOptions& options)
      : frames_(options.frames), end_(Instant{} + options.duration) {}

  /// Number of the frame that is drawn next, or was drawn last.
  [[nodiscard]] std::int64_t index() const { return index_; }
  /// Duration of the frame that follows the one drawn last, s.
  [[nodiscard]] double frame() const { return frame_; }
  /// When that frame ends.
  [[nodiscard]] Instant next() const { return next_; }

  /// A frame was drawn at t: what follows?
  void look(Instant t) {
    const double left = end_ - t;
    const double whole = frame_duration(frames_, index_);
    over_ = left <= 1e-9 * whole;  // a remainder that only rounding left over
    last_ = !(whole < left);
    frame_ = std::min(whole, left);
    next_ = last_ ? end_ : t + whole;
  }
  /// Whether nothing so far depends on when the run is to end.
  [[nodiscard]] bool whole() const { return whole_; }
  /// Whether the frame that follows is the last one, or none follows.
  [[nodiscard]] bool last() const { return last_; }
  /// Goes on to that frame; false where the run is over.
  [[nodiscard]] bool advance() {
    if (over_) {
      return false;
    }
    whole_ = whole_ && !last_;
    ++index_;
    return true;
  }

  void persist(Archive& archive) {
    archive(index_);
    archive.require(index_ >= 0 && index_ < most_frames);
  }

 private:
  static constexpr std::int64_t most_frames = std::int64_t{1} << 62;

  FrameTimes frames_;
  Instant end_;
  std::int64_t index_ = 0;
  double frame_ = 0.0;
  Instant next_;
  bool whole_ = true;
  bool over_ = false;
  bool last_ = false;
};

}  // namespace core
}  // namespace kairos
