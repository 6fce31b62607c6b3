#pragma once

#include "core/joint_system.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/penetration.hpp"
#include "simulation/simulate.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace kairos::tests {

/// It ends, the ledger closes, and in no frame do bodies overlap or joints open. `truncated`: of
/// all that flowed, what steps may be off.
inline void check_whole(const Simulation& sim, const Scene& scene, double truncated = 1e-9) {
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  check_explained(sim.result.ledger);
  const Model model(scene);
  const PenetrationProbe probe(model);
  double open = 0.0;
  std::vector<BodyState> states;
  for (std::size_t k = 0; k < sim.trajectory.frame_times().size(); ++k) {
    CHECK_FALSE(probe.first(sim.trajectory.frame_state(k)));
    for (const Island& island : model.islands()) {
      if (island.joints == nullptr) {
        continue;
      }
      states.clear();
      for (const BodyIndex i : island.bodies) {
        states.push_back(sim.trajectory.frame_state(k)[i]);
      }
      open = std::max(open, island.joints->residual(sim.trajectory.frame_times()[k], states));
    }
  }
  // Frames are within steps, whose own error is some 1e-12.
  CHECK(open < 1e-10);
  // What is left of motion is truncation of steps: a small part of all that flowed.
  CHECK(std::abs(sim.result.ledger.line(EnergyLine::truncation)) <
        truncated * sim.result.ledger.flow());
}

inline void check_whole(const Simulation& sim, const std::string& text, double truncated = 1e-9) {
  check_whole(sim, parse_scene(text, "test.toml"), truncated);
}

}  // namespace kairos::tests
