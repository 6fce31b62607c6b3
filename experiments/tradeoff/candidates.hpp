#pragma once

#include "core/model.hpp"
#include "simulation/simulate.hpp"

#include <string>
#include <vector>

namespace kairos::experiments {

/// A method that a person could sensibly choose for a scene.
struct Candidate {
  std::string name;   ///< short, unique
  std::string group;  ///< scheme, for figures
  RunChoice choice;

  /// The options of `kairos run` that choose it.
  [[nodiscard]] std::string options() const;
};

/// Every sensible combination of scheme, integrator, detector and frame or tolerance: frames of h,
/// h/4 and h/16 (h the scene's), `thesis` as the thesis has it, integrators that differ on this
/// scene. The order is that of the report; it depends on the model alone.
[[nodiscard]] std::vector<Candidate> sensible_candidates(const Model& model);

}  // namespace kairos::experiments
