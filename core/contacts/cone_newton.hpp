#pragma once

#include <Eigen/Core>

#include <vector>

namespace kairos {
inline namespace core {

/// Impulses p at all touches at once: u = W p + q with, by touch, 0 <= u_n, 0 <= p_n, u_n p_n = 0,
/// |p_t| <= mu p_n, and p_t against u_t where that is not 0.
struct ConeProblem {
  Eigen::MatrixXd W;             ///< 3 by touch, symmetric, positive semidefinite, 1/kg
  Eigen::VectorXd q;             ///< rates without impulses, m/s: normal, then two tangents
  std::vector<double> friction;  ///< by touch, >= 0; infinite: rough
};

/// Newton's method on the projections onto the cones, which are differentiable in pieces
/// [AlartCurnier1991]; of the steps that are as good the shortest, as touches may be redundant. It
/// comes to the end in few steps where sweeps touch by touch hardly move: light bodies between
/// heavy ones, wedges. It may go round in a circle; then it starts once more without impulses.
/// @param begin    impulses to begin with, N s, finite
/// @param settled  what is near enough, m/s
/// @returns the impulses that came nearest: maybe those to begin with
[[nodiscard]] Eigen::VectorXd cone_newton(const ConeProblem& problem, const Eigen::VectorXd& begin,
                                          double settled);

}  // namespace core
}  // namespace kairos
