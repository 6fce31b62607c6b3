#pragma once

#include "core/contacts/cone_problem.hpp"

#include <Eigen/Core>

namespace kairos {
inline namespace core {

/// Impulses at all touches at once by a primal-dual interior-point method: predictor and corrector
/// [Mehrotra1992], scaled as cones of second order are [NesterovTodd1997]. mu |u_t|, which
/// Coulomb's friction adds to the normal rate [DeSaxce1998], is a function of the impulses,
/// smoothed by as much as is left of the way, and part of each Newton step; [Acary2011] keep it,
/// and change it between solves. It stays away from the edges of the cones until the end, so that
/// among redundant touches it comes to the middle of what they may share; there a step of Newton's
/// method on the projections takes it to roundoff. It takes some twenty decompositions, and comes
/// to the end where sweeps touch by touch hardly move and Newton's method goes round in a circle.
/// That it does is seen, not proven.
/// @param begin    returned where nothing nearer is found, N s, finite
/// @param settled  what is near enough, m/s
[[nodiscard]] ConeImpulses cone_interior(const ConeProblem& problem, const Eigen::VectorXd& begin,
                                         double settled);

}  // namespace core
}  // namespace kairos
