#pragma once

#include "core/motion.hpp"

namespace kairos::ccd {

/// Upper bounds of how a body turns on an interval, rounding included.
struct RotationBounds {
  double speed = 0.0;         ///< of |w|, rad/s
  double acceleration = 0.0;  ///< of |dw/dt|, rad/s^2
};

/// On local times [s0, s1], s; `infinity` where |Q| cannot be bounded away from zero.
///
/// The motion turns as q = Q / |Q|, w = 2 Im(Q' Q*) / |Q|^2. So |w| <= 2 |Q'| / |Q|, and
///
///     dw/dt = 2 Im(Q'' Q*) / |Q|^2 - 2 (Q . Q') / |Q|^2 w.
///
/// |Im(Q'' Q*)| is |Q| times what of Q'' is across Q, and that is at most |Q'' + c Q| for every c:
/// with c near |w|^2 / 4 nothing is left of a turn at a constant rate. Norms are bounded by
/// Bernstein coefficients [Farouki2012], Q . Q' by the Taylor coefficients of |Q|^2, which is
/// nearly constant.
[[nodiscard]] RotationBounds rotation_bounds(const Motion& motion, double s0, double s1);

}  // namespace kairos::ccd
