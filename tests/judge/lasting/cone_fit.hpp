#pragma once

#include "tests/judge/lasting/real.hpp"

#include <vector>

namespace kairos::judge {

/// What a force of one point may be: a sum of rays with weights >= 0, and of a Coulomb cone.
struct ForceSet {
  /// What a unit force along each world axis gives.
  Eigen::Matrix<Real, Eigen::Dynamic, 3> gives;
  Vector normal;
  /// Where it slides: the only direction; otherwise zero, and all of the cone is allowed.
  Vector ray = Vector::Zero();
  Real friction = 0;  ///< of the cone; may be infinite
};

struct ConeFit {
  std::vector<Vector> forces;  ///< by set
  Column left;                 ///< of what was asked for
  int rays = 0;                ///< that were tried
};

/// The forces within their sets that come nearest to what is asked for. Rays of the round cones are
/// made as they are needed, each the one that the rest pulls most (a fully corrective Frank-Wolfe
/// method), and weights are found by Lawson and Hanson's active sets [Lawson1974, ch. 23]: exact
/// for the round cone, in long double. What is left may be as much as `enough`: the search ends
/// there.
[[nodiscard]] ConeFit fit(const std::vector<ForceSet>& sets, const Column& asked, Real enough = 0);

}  // namespace kairos::judge
