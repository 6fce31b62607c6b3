#pragma once

#include "core/scheme.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// `pgs`: projected Gauss-Seidel on velocities, as in games [Catto2005]. Symplectic Euler:
/// v1 = v0 + h F0/m + contact impulses, x1 = x0 + h v1. Contacts are the points that overlap when
/// the step begins, or are apart by at most `slop`; `iterations` sweeps clamp their accumulated
/// impulses, first two tangential ones to [-mu p_n, mu p_n] each (a pyramid, not a cone), then the
/// normal one to p_n >= 0. A point that is apart may close its gap within the step; one that
/// overlaps is to separate with beta/h times the penetration beyond `slop` (Baumgarte); either
/// rebounds with e times an approach that is faster than `restitution_threshold` and meets within
/// the step, where that is more. Warm starting begins with the impulses of the last step.
[[nodiscard]] std::unique_ptr<Scheme> make_pgs();

}  // namespace core
}  // namespace kairos
