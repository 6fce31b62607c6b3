#include "experiments/rally/hand_path.hpp"

#include <algorithm>
#include <cassert>

namespace kairos::experiments {

void HandPath::move(double begin, double end, const Pose& to) {
  assert(begin < end && (moves_.empty() || moves_.back().end <= begin));
  moves_.push_back({begin, end, moves_.empty() ? start_ : moves_.back().to, to});
}

PathPoint HandPath::at(double t) const {
  const auto after = std::upper_bound(moves_.begin(), moves_.end(), t,
                                      [](double time, const Move& m) { return time < m.begin; });
  if (after == moves_.begin()) {
    return {start_};
  }
  const Move& m = *(after - 1);
  const double duration = m.end - m.begin;
  const double x = std::min((t - m.begin) / duration, 1.0);
  const double s = x * x * x * (10.0 + x * (6.0 * x - 15.0));
  const double rate = 30.0 * x * x * (1.0 - x) * (1.0 - x) / duration;
  const Vector3 way = m.to.position - m.from.position;
  return {{m.from.position + s * way, m.from.orientation.slerp(s, m.to.orientation)}, rate * way};
}

}  // namespace kairos::experiments
