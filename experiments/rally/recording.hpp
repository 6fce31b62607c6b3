#pragma once

#include "core/drives/track.hpp"
#include "core/reading/track_reader.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace kairos::experiments {

/// What a rally before two trackers is like (ch. 7): the hand fetches the ball, drops it, and the
/// bat strikes it, again and again. Every stroke starts with a served ball, so that strokes do not
/// depend on what became of the one before, whatever scheme is judged by them.
struct RallyOptions {
  std::uint64_t seed = 1;
  int strokes = 24;
  double rate = 60.0;         ///< samples per second of each tracker
  double noise = 0.0005;      ///< standard deviation of a coordinate, m
  double angle_noise = 0.15;  ///< of a turn about each axis, degrees
  double slowest = 2.0;       ///< greatest speed of a stroke is uniform between these, m/s
  double fastest = 8.0;
};

/// One stroke as it was meant; seconds and metres.
struct Stroke {
  double begin = 0.0;    ///< the fist closes
  double release = 0.0;  ///< and opens
  double hit = 0.0;      ///< the bat is half way, at its fastest
  double end = 0.0;      ///< the next one begins
  double speed = 0.0;    ///< of the bat then, m/s
  Vector3 place = Vector3::Zero();
};

/// Two recordings, and the truth behind them.
struct RallyRecording {
  Recording bat;                      ///< positions as a tracker tells them: with noise
  Recording hand;                     ///< the same, with gestures
  std::vector<Vector3> bat_velocity;  ///< the true one, at the bat's samples, m/s
  std::vector<Stroke> strokes;
  [[nodiscard]] double duration() const { return strokes.back().end; }
};

/// The same options, the same bits. Numbers are those that the CSV files hold.
[[nodiscard]] RallyRecording make_rally(const RallyOptions& options);

/// What ch. 8.2 tells: a stroke down and to the right, the hand fetches the ball and drops it, and
/// a stroke towards the viewer. Noise and seed of the options count, the rest is told by the story.
[[nodiscard]] RallyRecording make_session(const RallyOptions& options);

/// As a CSV file that `[body.drive] track` reads. The bat's has the true velocity in three columns
/// more, which readers of tracks ignore.
[[nodiscard]] std::string bat_csv(const RallyRecording& rally);
[[nodiscard]] std::string hand_csv(const RallyRecording& rally);
/// The plan: one row per stroke.
[[nodiscard]] std::string strokes_csv(const RallyRecording& rally);

}  // namespace kairos::experiments
