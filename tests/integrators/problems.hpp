#pragma once

#include "core/force.hpp"

#include <memory>
#include <string>
#include <vector>

namespace kairos::integrators::test {

/// A smooth initial-value problem of one body with its solution at sampled times.
struct Problem {
  std::string name;
  Island island;
  std::vector<std::unique_ptr<const Force>> forces;  ///< what `island.forces` points to
  BodyState initial;
  double duration = 0.0;            ///< s
  std::vector<double> times;        ///< s, ascending, the last is `duration`
  std::vector<BodyState> solution;  ///< at `times`, to about 1e-17 of its scale
  std::vector<BodyState> quarters;  ///< at each quarter of `duration`
};

/// A planet on an ellipse that also turns as an asymmetric heavy top: both parts nonlinear, forces
/// that depend on position and orientation alone. In 6 s it goes round more than once.
[[nodiscard]] Problem make_kepler_top(double duration);
/// A free asymmetric top on a parabola.
[[nodiscard]] Problem make_free_top(double duration);
/// A damped spring to an anchor that is shaken: depends on velocity and time. Does not rotate.
[[nodiscard]] Problem make_shaken_spring(double duration);

/// The same over 2 s, made once.
[[nodiscard]] const Problem& kepler_top();
[[nodiscard]] const Problem& free_top();
[[nodiscard]] const Problem& shaken_spring();

}  // namespace kairos::integrators::test
