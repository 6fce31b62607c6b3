#pragma once

#include "core/model.hpp"
#include "tests/fuzz/fuzz_target.hpp"

#include <cmath>

namespace kairos::fuzz {

/// What holds of every model that was made of a text, whatever the text.
inline void check(const Model& model) {
  for (const BodyState& s : model.initial_state()) {
    require(std::isfinite(s.pose.position.sum() + s.twist.linear.sum() + s.twist.angular.sum()),
            "a body starts where no number is");
    require(std::abs(s.pose.orientation.norm() - 1.0) < 1e-9, "an orientation is not unit");
  }
  for (BodyIndex i = 0; i < model.size(); ++i) {
    require(std::isfinite(model.gravity_force(i).sum()), "gravity is not finite");
    require(std::isfinite(model.kinetic_energy(i, model.body(i).initial)), "energy is not finite");
  }
}

}  // namespace kairos::fuzz
