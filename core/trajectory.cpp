#include "core/trajectory.hpp"

#include <algorithm>
#include <cassert>

namespace kairos {
inline namespace core {

void Trajectory::begin(const Model& model) {
  events_.clear();
  frame_times_.clear();
  frames_.clear();
  motions_.assign(model.size(), {});
}

void Trajectory::frame(const Frame& frame) {
  frame_times_.push_back(frame.time);
  frames_.emplace_back(frame.bodies.begin(), frame.bodies.end());
}

void Trajectory::motion(BodyIndex body, const Motion& motion) { motions_[body].push_back(motion); }

void Trajectory::event(const Event& event) { events_.push_back(event); }

BodyState Trajectory::at(BodyIndex body, Instant t) const {
  const std::vector<Motion>& motions = motions_[body];
  assert(!motions.empty());
  // The last motion that starts by t: a later one ends an earlier one.
  const auto next =
      std::upper_bound(motions.begin(), motions.end(), t,
                       [](Instant time, const Motion& motion) { return time < motion.start; });
  const Motion& motion = next == motions.begin() ? *next : *std::prev(next);
  const double s = std::clamp(t - motion.start, 0.0, motion.duration);
  return {motion.pose(s), motion.twist(s)};
}

}  // namespace core
}  // namespace kairos
