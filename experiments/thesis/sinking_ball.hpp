#pragma once

#include "core/contact_detector.hpp"
#include "core/motion.hpp"
#include "core/shape.hpp"

#include <string>

namespace kairos::experiments::thesis {

/// The frame of figs. 13 and 14: a ball that moves down and to the right, outside the wall at its
/// beginning and inside at its end, as the thesis' stepping moved it.
struct SinkingBall {
  Shape shape;
  double radius = 0.0;  ///< m
  Shape wall;
  Pose wall_pose;
  Motion path;          ///< of the ball over that frame
  TimeOfImpact impact;  ///< of that path and the wall; times from its start
  std::string command;  ///< that repeats the run
};
[[nodiscard]] SinkingBall sinking_ball_run();

}  // namespace kairos::experiments::thesis
