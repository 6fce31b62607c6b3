#pragma once

#include "core/pose.hpp"

#include <vector>

namespace kairos::experiments {

/// A pose and how fast it changes.
struct PathPoint {
  Pose pose;
  Vector3 velocity = Vector3::Zero();  ///< m/s
};

/// How a person moves a hand: from rest to rest along a straight line, each time with the least
/// jerk, s(x) = 10 x^3 - 15 x^4 + 6 x^5 [Flash1985]; turns follow the same law. Between two
/// moves it holds still. The greatest speed of a move over the distance d in the time T is
/// 15/8 d/T, half way.
class HandPath {
 public:
  explicit HandPath(const Pose& start) : start_(start) {}

  /// From where the last move ends; moves follow each other in time. Seconds.
  void move(double begin, double end, const Pose& to);
  [[nodiscard]] PathPoint at(double t) const;

 private:
  struct Move {
    double begin, end;
    Pose from, to;
  };
  Pose start_;
  std::vector<Move> moves_;
};

}  // namespace kairos::experiments
