#pragma once

#include "simulation/simulate.hpp"

#include <functional>
#include <string>
#include <vector>

namespace kairos::experiments {

/// A scene with contact that lasts, or with joints, and one number of it that is known.
struct ReferenceProblem {
  std::string name;
  std::string quantity;
  std::string unit;
  double truth = 0.0;  ///< computed with 25 digits or in closed form, given to 12
  std::string toml;
  std::string impact = "newton";  ///< law, of schemes that take one
  /// The quantity of a run; not a number where the run does not tell it.
  std::function<double(const Simulation&)> measured;
  /// What event-driven may be off by: the truth is rounded to 12 digits. Bodies that turn while
  /// they touch are held at a gap of up to 1e-10 of their size, which shows in when they part.
  double within = 3e-11;
  /// It is when something happens, or how fast then: schemes that learn of contact at the ends of
  /// their steps tell no such moment.
  bool of_moment = false;
};

/// Blocks, balls, stacks, bars and pendulums; in the order of the report.
[[nodiscard]] std::vector<ReferenceProblem> reference_problems();

}  // namespace kairos::experiments
