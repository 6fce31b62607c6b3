#pragma once

#include "ccd/core_pair.hpp"

namespace kairos::ccd {

/// A direction of greatest separation made as good as rounding allows, from one that is near: what
/// is a face's normal or across an edge of each is taken exactly; where a rim or a side that is
/// round is nearest, Newton's method on n . d less the supports, whose second derivative on a
/// circle of radius r is r / |m across its axis| along its tangent. `r`: between points of both
/// that are nearest, if known. Changes nothing that does not separate better.
void polish(const CorePair& pair, const Vector3& r, Vector3& n, double& separation);

/// How deep the cores are proven to overlap by four points, off by `error`, around those along n; 0
/// if nothing is proven. For round ones, whose polytopes would need many points. `depth`: about how
/// deep they are, m.
[[nodiscard]] double depth_by_tetrahedron(const CorePair& pair, const Vector3& n, double depth,
                                          double error);

}  // namespace kairos::ccd
