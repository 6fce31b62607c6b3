#pragma once

#include "core/pose.hpp"

namespace kairos {
inline namespace core {

/// One contact with Coulomb's friction, all others held: the impulse p with u = W p + q,
/// 0 <= u_n, 0 <= p_n, u_n p_n = 0, |p_t| <= mu p_n, and p_t = -mu p_n u_t/|u_t| where u_t is not
/// 0: the exact cone, the same in all directions [Jean1999, Jourdan1998]. Components: normal, then
/// two tangents. `W`: symmetric, positive definite; but rows and columns of tangents may be 0,
/// along which joints let nothing move. `mu` >= 0, may be infinite.
///
/// Apart, sticking and sliding are tried in this order. Sliding asks for the one unknown angle of
/// u_t: Newton's method from where sticking would have to hold, or a bracketed root; to roundoff.
[[nodiscard]] Vector3 coulomb_impulse(const Matrix3& W, const Vector3& q, double mu);

}  // namespace core
}  // namespace kairos
