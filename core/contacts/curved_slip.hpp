#pragma once

#include "core/polynomial.hpp"

namespace kairos {
inline namespace core {

/// How two surfaces slide whose sliding turns: u' = pull - brake u/|u|.
struct CurvedSlip {
  Polynomial<3> direction;  ///< u/|u|
  Polynomial<3> speed;      ///< |u|, as the x, m/s
  double duration = 0.0;    ///< s, within which both are true to roundoff; before it stops
};

/// From u = `slip` (m/s, not 0) on, by Taylor series of order 11, for at most `at_most` seconds.
/// `pull`: m/s^2, along the surface; `brake`: m/s^2, >= 0.
[[nodiscard]] CurvedSlip curved_slip(const Vector3& slip, const Vector3& pull, double brake,
                                     double at_most);

}  // namespace core
}  // namespace kairos
