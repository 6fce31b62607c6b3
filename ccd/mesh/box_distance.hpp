#pragma once

#include "ccd/mesh/mesh_pair.hpp"

namespace kairos::ccd {

/// Less than the distance of two boxes, or negative where nothing is proven. Any direction n proves
/// (|n . d| - reach of a - reach of b) / |n|: here the axes of both, in each frame added up to the
/// distance from the box around the other one, and the products of their edges. Stops once `enough`
/// is proven. `error`: of each coordinate of the centre of b; its axes are off by at most 64 u.
[[nodiscard]] double box_distance(const ObbBox& a, const ObbBox& b, double error, double enough);
/// The same for a box and a triangle. `error`: of each coordinate of either, against the other.
[[nodiscard]] double box_distance(const ObbBox& box, const Corners& t, double error);

}  // namespace kairos::ccd
