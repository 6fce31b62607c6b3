#include "experiments/metrics/metric_joints.hpp"

#include "core/joint_system.hpp"

#include <algorithm>

namespace kairos::experiments {

JointWatch::JointWatch(const Model& model) {
  for (const Island& island : model.islands()) {
    if (island.joints != nullptr) {
      islands_.push_back(&island);
    }
  }
}

void JointWatch::frame(const Frame& frame) {
  for (const Island* island : islands_) {
    states_.clear();
    for (const BodyIndex i : island->bodies) {
      states_.push_back(frame.bodies[i]);
    }
    const double residual = island->joints->residual(frame.time, states_);
    max_drift_ = std::max(max_drift_, residual / island->joints->size());
  }
}

}  // namespace kairos::experiments
