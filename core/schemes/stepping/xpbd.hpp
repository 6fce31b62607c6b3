#pragma once

#include "core/scheme.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// `xpbd`: extended position based dynamics of rigid bodies [Mueller2020, algorithm 2]. In each
/// substep bodies move without contacts; points that overlap then are moved apart, one after the
/// other, by dlambda = (depth - alpha/h^2 lambda)/(w_a + w_b + alpha/h^2), and back along the
/// surface while that takes less than mu lambda; velocities are what positions changed by; and at
/// last they get the restitution (none for approaches below 2 |g| h) and the sliding friction of
/// the paper. Two readings of ours: the approach that is compared with 2 |g| h is that before
/// positions were solved; and sliding friction is limited to the impulse mu lambda/h, while eq. 30
/// compares that with a velocity.
[[nodiscard]] std::unique_ptr<Scheme> make_xpbd();

}  // namespace core
}  // namespace kairos
