#pragma once

#include "ccd/core_pair.hpp"

namespace kairos::ccd {

/// What separates two cores, or how deep they are in each other. All but `depth` and the distance
/// of the points is a proposal whose worth is in `separation`.
struct CoreWitness {
  Vector3 n = Vector3::UnitX();  ///< unit, from a to b
  double separation = 0.0;       ///< along n, m: apart where positive; off by the rounding error
  double upper = 0.0;            ///< distance of on_a and on_b, m: theirs is no more
  double depth = 0.0;            ///< they are proven to overlap by so much; 0: nothing is proven, m
  Vector3 on_a = Vector3::Zero();  ///< points of both, from the origin of a, world axes
  Vector3 on_b = Vector3::Zero();
};

/// The direction of greatest separation. Apart by more than 1e-6 of their size: by GJK, to
/// `precision` of the distance. Nearer than that GJK's direction is noise over the distance: there,
/// and inside, the polytope of the difference is expanded with b moved a little into a, and
/// directions that are exactly a face's normal or across two edges are tried. `error` bounds the
/// rounding of a separation, m.
/// `reach`: the distance at which the bodies around the cores touch, m; near it the direction is
/// made as good as rounding allows.
[[nodiscard]] CoreWitness core_witness(const CorePair& pair, double reach, double precision,
                                       double error);

}  // namespace kairos::ccd
