#include "experiments/metrics/metric_between.hpp"

#include <algorithm>

namespace kairos::experiments {

BetweenWatch::BetweenWatch(const Model& model)
    : probe_(model), motions_(model.size()), initial_(model.initial_state()), sample_(initial_) {}

void BetweenWatch::motion(BodyIndex body, const Motion& motion) {
  motions_[body].push_back(motion);
}

BodyState BetweenWatch::state_at(BodyIndex body, Instant t) const {
  const auto& motions = motions_[body];
  for (auto motion = motions.rbegin(); motion != motions.rend(); ++motion) {
    if (motion->start <= t) {
      const double s = std::min(t - motion->start, motion->duration);
      return {motion->pose(s), motion->twist(s)};
    }
  }
  return initial_[body];
}

void BetweenWatch::frame(const Frame& frame) {
  if (drawn_) {
    const double interval = frame.time - last_;
    for (int k = 0; k < samples; ++k) {
      const Instant t = last_ + interval * (k + 0.5) / samples;
      for (BodyIndex i = 0; i < motions_.size(); ++i) {
        sample_[i] = state_at(i, t);
      }
      const auto deepest = probe_.deepest(sample_, frame.in_hand);
      max_depth_ = std::max(max_depth_, deepest ? deepest->depth : 0.0);
    }
    for (auto& motions : motions_) {
      while (motions.size() > 1 && motions[1].start <= frame.time) {
        motions.pop_front();
      }
    }
  }
  last_ = frame.time;
  drawn_ = true;
}

}  // namespace kairos::experiments
