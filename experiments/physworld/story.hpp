#pragma once

#include "core/recorder.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// What a caption of ch. 8.1 says, as a moment of a run.
struct Told {
  std::string_view what;
  double time = -1.0;  ///< s; negative: not in this run
  int frame = 0;       ///< of the nine
};

/// How much of ch. 8.1 a run of `physworld` tells, in the order of the captions.
struct Story {
  std::vector<Told> moments;  ///< up to the first that is missing
  bool complete = false;
  std::string_view missing;        ///< what is missing or out of order
  std::array<double, 9> frames{};  ///< times of nine pictures, s; only if complete
};

/// Watches the three balls of `physworld` (red, blue, green), its floor, wall, conveyor and pad.
class StoryRecorder : public Recorder {
 public:
  void begin(const Model& model) override;
  void frame(const Frame& frame) override;
  void event(const Event& event) override;

  [[nodiscard]] Story story() const;

 private:
  /// An event between two names, and the velocities before and after.
  struct Seen {
    double time;
    EventKind kind;
    std::string_view a, b;
    Vector3 before_a, after_a, before_b, after_b;
    Vector3 place_a, place_b;
  };
  class Teller;

  const Model* model_ = nullptr;
  std::vector<Seen> seen_;
  double green_turns_ = -1.0;
  bool green_inside_ = false;
};

}  // namespace kairos::experiments
