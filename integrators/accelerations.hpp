#pragma once

#include "core/archive.hpp"
#include "core/force.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kairos::integrators {

/// Second derivatives of one body, world frame.
struct Acceleration {
  Vector3 linear = Vector3::Zero();   ///< m/s^2
  Vector3 angular = Vector3::Zero();  ///< rad/s^2

  void persist(Archive& archive) { archive(linear, angular); }
};

/// Evaluates the accelerations of an island and counts how often. Holds the scratch space, so that
/// stepping does not allocate.
class Accelerations {
 public:
  void resize(std::size_t bodies) { wrenches_.resize(bodies); }
  [[nodiscard]] std::int64_t evaluations() const { return evaluations_; }
  void persist(Archive& archive) { archive(evaluations_); }

  void evaluate(const Island& island, Instant t, std::span<const BodyState> states,
                std::span<Acceleration> out) {
    ++evaluations_;
    if (island.constant_acceleration()) {
      for (std::size_t i = 0; i < states.size(); ++i) {
        const BodyInertia& inertia = island.inertia[i];
        out[i].linear = island.constant_force[i] / inertia.mass;
        if (inertia.rotates) {
          out[i].angular = angular_acceleration(inertia, states[i], Vector3::Zero());
        }
      }
      return;
    }
    evaluate_coupled(island, t, states, out);
  }

 private:
  void evaluate_coupled(const Island& island, Instant t, std::span<const BodyState> states,
                        std::span<Acceleration> out);

  std::vector<Wrench> wrenches_;
  std::int64_t evaluations_ = 0;
};

}  // namespace kairos::integrators
