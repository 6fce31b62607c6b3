#pragma once

#include "ccd/gjk.hpp"

namespace kairos::ccd {

/// How deep 0 is in B - A.
struct Expansion {
  bool found = false;
  Vector3 n = Vector3::UnitX();  ///< unit, from a to b: along it they part soonest
  /// 0 is proven to be so deep within the hull of points of B - A, those off by `error`; else 0.
  double depth = 0.0;
  Vector3 on_a = Vector3::Zero();  ///< deepest points, from the origin of a, world axes
  Vector3 on_b = Vector3::Zero();
};

/// Expands a polytope of points of B - A, nearest face first, until that is within `precision` (m)
/// of the boundary [VandenBergen2001]. `pair` is the true one with b moved by `shift`, such that 0
/// is inside; directions and depth are for the true one. `inside`: where `gjk` ended, 0 inside.
///
/// *Proof of the depth.* The faces are always a closed surface: what a new point sees is replaced
/// by a fan around its rim. If seen from 0 all of them turn the same way, by more than what `error`
/// and rounding could make, the surface goes round 0 at least once, so that 0 is in the hull of its
/// points; and it is as far from 0 as its nearest plane.
[[nodiscard]] Expansion expand(const CorePair& pair, const Vector3& shift, const Simplex& inside,
                               double precision, double error);

}  // namespace kairos::ccd
