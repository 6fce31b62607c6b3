#include "integrators/accelerations.hpp"

namespace kairos::integrators {

void Accelerations::evaluate_coupled(const Island& island, Instant t,
                                     std::span<const BodyState> states,
                                     std::span<Acceleration> out) {
  island.wrenches(t, states, wrenches_);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const BodyInertia& inertia = island.inertia[i];
    out[i].linear = wrenches_[i].force / inertia.mass;
    if (inertia.rotates) {
      out[i].angular = angular_acceleration(inertia, states[i], wrenches_[i].torque);
    }
  }
}

}  // namespace kairos::integrators
