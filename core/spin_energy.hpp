#pragma once

#include "core/force.hpp"

namespace kairos {
inline namespace core {

/// Angular velocity of a body, rad/s, along its principal axes. A quaternion is a rotation whatever
/// its length, and computed ones are a few eps longer or shorter than 1, which `q * x` counts up to
/// four times: here it is divided out, in double-doubles, and each component is off by one
/// rounding.
[[nodiscard]] Vector3 principal_rates(const BodyInertia& inertia, const BodyState& state);

/// Kinetic energy of its rotation, J, off by 3 eps of itself at most: each rate is rounded, and
/// squared; two products and two sums are rounded. What turns at a constant rate so keeps the
/// energy that is told of it, to twice that, which is below the 8 eps of the ledger. (Principal
/// axes that are not the body's own are turned by their product with its orientation as it is
/// rounded.)
[[nodiscard]] double spin_energy(const BodyInertia& inertia, const BodyState& state);

}  // namespace core
}  // namespace kairos
