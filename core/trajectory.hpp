#pragma once

#include "core/recorder.hpp"

#include <vector>

namespace kairos {
inline namespace core {

/// A run kept in memory: motion segments and events; frames are sampled from them.
class Trajectory : public Recorder {
 public:
  void begin(const Model& model) override;
  [[nodiscard]] bool wants_motions() const override { return true; }
  void frame(const Frame& frame) override;
  void motion(BodyIndex body, const Motion& motion) override;
  void event(const Event& event) override;

  /// In order of time.
  [[nodiscard]] const std::vector<Event>& events() const { return events_; }
  /// Motions of one body, in order; each is valid until the next one starts.
  [[nodiscard]] const std::vector<Motion>& motions(BodyIndex body) const { return motions_[body]; }
  /// Times of the frames that were drawn.
  [[nodiscard]] const std::vector<Instant>& frame_times() const { return frame_times_; }
  /// Bodies as drawn in frame n.
  [[nodiscard]] const State& frame_state(std::size_t n) const { return frames_[n]; }
  /// Pose and twist of a body at any time of the run, from its motions.
  [[nodiscard]] BodyState at(BodyIndex body, Instant t) const;

 private:
  std::vector<Event> events_;
  std::vector<std::vector<Motion>> motions_;
  std::vector<Instant> frame_times_;
  std::vector<State> frames_;
};

}  // namespace core
}  // namespace kairos
