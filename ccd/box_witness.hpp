#pragma once

#include "ccd/nearest_points.hpp"
#include "ccd/witness.hpp"

namespace kairos::ccd {

/// Two boxes of a query as the separating-axis test sees them.
[[nodiscard]] RelativeBoxes relative_boxes(const PairMotion& motion, const Kinematics& k);

/// The witness along one of the 15 axes, of unit length and evaluated afresh: its error is that of
/// any direction, however small the sine of the edges (eq. 5). Empty (`gap` negative infinity) for
/// edges that are exactly parallel.
[[nodiscard]] Witness along_axis(const PairMotion& motion, const Kinematics& k, int axis);

/// The greatest separation of two boxes; with error radii, where they may touch, the distance.
[[nodiscard]] Witness between_boxes(const PairMotion& motion, const Kinematics& k);

/// Two boxes proven to overlap; with error radii, proven to be nearer than these (eq. 6, 7).
[[nodiscard]] bool boxes_proven_overlapping(const PairMotion& motion, const Kinematics& k,
                                            const Witness& witness);

}  // namespace kairos::ccd
