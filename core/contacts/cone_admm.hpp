#pragma once

#include "core/contacts/cone_problem.hpp"

#include <Eigen/Core>

namespace kairos {
inline namespace core {

/// Impulses at all touches at once by the alternating direction method of multipliers, with a
/// proximal term and a penalty that follows what is left [Boyd2011, Carpentier2024]. Coulomb's
/// friction is a projection onto cones where mu |u_t| is added to the normal rate, which follows
/// what was found last [DeSaxce1998]. It takes some hundred products with one decomposition, and
/// comes to the end among many redundant touches, where sweeps touch by touch hardly move and
/// Newton's method goes round in a circle. That it does is seen, not proven.
/// @param begin    returned where nothing nearer is found, N s, finite
/// @param settled  what is near enough, m/s
[[nodiscard]] ConeImpulses cone_admm(const ConeProblem& problem, const Eigen::VectorXd& begin,
                                     double settled);

}  // namespace core
}  // namespace kairos
