#pragma once

#include "core/event.hpp"
#include "core/state.hpp"
#include "experiments/sweeps/sweep_spec.hpp"

#include <functional>
#include <string>
#include <vector>

namespace kairos::experiments {

/// What a method left of an extreme scene.
struct ExtremeRun {
  State end;
  std::vector<double> impacts;  ///< times, s
};

/// One cell of the stability map: a scene far out on one or two axes, whose answer is known in
/// closed form.
struct ExtremeCase {
  std::string family;
  std::string x_name;
  double x = 0.0;
  std::string y_name;  ///< empty: one axis
  double y = 0.0;
  std::string toml;
  /// How far from the truth, relative to what happens in the scene: 1 is as wrong as can be.
  std::function<double(const ExtremeRun&)> error;
};

/// Every cell, in the order of the report.
[[nodiscard]] std::vector<ExtremeCase> extreme_cases(Size size);

}  // namespace kairos::experiments
