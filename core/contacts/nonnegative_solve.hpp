#pragma once

#include <Eigen/Core>

namespace kairos {
inline namespace core {

/// x of least |A x - b|, x_j >= 0 for j >= `free` [Lawson1974, ch. 23].
struct NonnegativeSolution {
  Eigen::VectorXd x;
  double residual = 0.0;  ///< largest |A x - b| of a row
  int solves = 0;         ///< of linear systems: the counted work
};

/// The first `free` unknowns may have any sign. Columns should be of like lengths.
[[nodiscard]] NonnegativeSolution solve_nonnegative(const Eigen::MatrixXd& A,
                                                    const Eigen::VectorXd& b, Eigen::Index free);

}  // namespace core
}  // namespace kairos
