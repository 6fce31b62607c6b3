#pragma once

#include "core/model.hpp"
#include "core/recorder.hpp"
#include "simulation/view/actor.hpp"

#include <string>
#include <vector>

namespace kairos::experiments {

/// A run as a person saw it: bodies, and where they were in each drawn frame.
struct Footage {
  struct Picture {
    double time = 0.0;  ///< s
    std::vector<Pose> poses;
  };
  std::string title;  ///< of the scene
  std::string method;
  std::vector<Actor> actors;
  std::vector<Joint> joints;
  std::vector<Picture> pictures;

  /// Index of the last picture drawn at `time` or before; the first one before that. Not empty.
  [[nodiscard]] std::size_t at(double time) const;
};

/// Keeps the drawn frames of a run.
class FootageRecorder : public Recorder {
 public:
  void begin(const Model& model) override;
  void frame(const Frame& frame) override;
  [[nodiscard]] const Footage& footage() const { return footage_; }

 private:
  Footage footage_;
};

/// Reads what `kairos run --out` left: a folder, or its `trajectory.csv` with `summary.json` beside
/// it. Throws `InputError` with the file and line of what is missing or wrong.
[[nodiscard]] Footage read_footage(const std::string& path);

}  // namespace kairos::experiments
