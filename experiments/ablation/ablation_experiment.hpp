#pragma once

#include "core/model.hpp"
#include "experiments/sweeps/experiment_program.hpp"
#include "simulation/simulate.hpp"

#include <string>
#include <vector>

namespace kairos::experiments {

/// A saving of `Model`, a scene on which it saves, and how to run that without it.
struct Ablation {
  std::string saving;
  std::string scene;  ///< name of a shipped scene, or a made one
  Scene made;
  ModelOptions without;  ///< that one saving switched off
  RunChoice choice;
  double tolerance = 0.0;  ///< m: 0 where the two must agree in every bit, roundoff otherwise
};
[[nodiscard]] std::vector<Ablation> ablations();

/// The same run with and without.
struct Ablated {
  Cost with, without;
  double difference = 0.0;  ///< m, of the farthest body at the end
};
[[nodiscard]] Ablated ablate(const Ablation& ablation);

[[nodiscard]] ProgramOutput run_ablation(const ExperimentSpec& spec, Size size,
                                         std::size_t threads);

}  // namespace kairos::experiments
