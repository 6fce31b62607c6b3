#pragma once

#include "core/model.hpp"
#include "core/recorder.hpp"
#include "experiments/random/scene_trial.hpp"

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace kairos::experiments {

/// Thrown where a run breaks a promise.
struct BrokenPromise {
  Fate fate;
  std::string what;
  double time;  ///< s
};

/// Holds a run to what it promises, by checks that share nothing with it; ends it at the first
/// promise that is broken.
class SceneWatch : public Recorder {
 public:
  /// More events in a frame than any of these scenes has: they last for a few crossings of the
  /// room. A run that takes more must stop by itself.
  static constexpr std::int64_t most_in_frame = 100'000;

  void begin(const Model& model) override { model_ = &model; }
  void frame(const Frame& frame) override;
  void event(const Event& event) override;

 private:
  void check_energy(const Frame& frame) const;
  /// What friction and hops that die down took grows from frame to frame.
  void check_dissipation(const Frame& frame);
  void check_joints(std::span<const BodyState> bodies, Instant t) const;
  /// Impacts of one instant: each as its law says.
  void check_impacts();
  [[nodiscard]] double handed_on(const Event& event) const;
  [[nodiscard]] double momentum(const Event& event) const;
  [[nodiscard]] double coordinates(BodyIndex a, const BodyState& at_a, BodyIndex b,
                                   const BodyState& at_b) const;
  void check_overlap(std::span<const BodyState> bodies, Instant t) const;
  void check_pair(BodyIndex a, const BodyState& state_a, BodyIndex b, const BodyState& state_b,
                  Instant t) const;
  [[nodiscard]] Pose seen(BodyIndex b, Pose pose_b, BodyIndex a, const Pose& pose_a) const;
  void check_contacts(std::span<const BodyState> bodies, Instant t) const;
  [[nodiscard]] std::string names(BodyIndex a, BodyIndex b) const;

  const Model* model_ = nullptr;
  std::int64_t events_ = 0;
  std::vector<Event> at_once_;  ///< impacts of one instant, not yet checked
  /// Pairs in contact, and the largest coordinates that they had since that began, m.
  std::map<std::pair<BodyIndex, BodyIndex>, double> in_contact_;
  std::array<double, 3> dissipated_{};  ///< J, <= 0, up to the last frame
};

}  // namespace kairos::experiments
