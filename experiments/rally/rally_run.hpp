#pragma once

#include "core/scene.hpp"
#include "experiments/rally/interval.hpp"
#include "experiments/rally/stroke_watch.hpp"
#include "simulation/simulate.hpp"

#include <string>
#include <vector>

namespace kairos::experiments {

/// One way to play a rally: a method, and what the bat does to what it hits.
struct RallyMethod {
  std::string name;
  RunChoice choice = {};
  double nudge = 0.0;        ///< s, 13.9
  double nudge_prose = 0.0;  ///< s, 7.4
  double bat_mass = 0.18;    ///< kg
  /// As in the thesis: balls collide as their boxes, and gravity is a force (which pulls the ball
  /// with 9.8 m/s^2 all the same).
  bool boxes = false;
};

/// What is asked on `table-tennis`: the thesis' scheme without and with the nudge (at five factors,
/// in both readings), the same with a bat as heavy as the ball, its cures, and both with the
/// thesis' boxes and force.
[[nodiscard]] std::vector<RallyMethod> rally_methods();

/// The scene `table-tennis` with these recordings in place of its own.
[[nodiscard]] Scene rally_scene(const RallyRecording& rally, const RallyMethod& method);

struct RallyOutcome {
  RunStatus status = RunStatus::completed;
  std::string reason;
  std::vector<StrokeOutcome> strokes;
  std::vector<SpeedReading> speeds;

  /// Strokes that passed through the ball, of all.
  [[nodiscard]] Cluster passed() const;
};
[[nodiscard]] RallyOutcome play(const RallyRecording& rally, const RallyMethod& method);

}  // namespace kairos::experiments
