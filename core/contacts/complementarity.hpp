#pragma once

#include <Eigen/Core>

namespace kairos {
inline namespace core {

/// A solution x of 0 <= x, 0 <= W x + q, x . (W x + q) = 0.
struct Complementarity {
  Eigen::VectorXd x;
  bool solved = false;  ///< verified, see `complementary`
  int solves = 0;       ///< of linear systems: the counted work
};

/// Solves the linear complementarity problem of a symmetric positive semidefinite W: what contacts
/// do to each other without friction, J M^-1 J^T. W x is unique, x where W is regular.
///
/// The first guess is that all rows press, by the solution of least norm (a pile at rest takes one
/// solve). Then an active set grows by the row most violated and drops rows that would pull
/// [Lawson1974, ch. 23], with at most 3 n solves. A result that is `solved` was verified;
/// `tolerance` (roundoff) is relative to the largest terms of each row.
[[nodiscard]] Complementarity solve_complementarity(const Eigen::MatrixXd& W,
                                                    const Eigen::VectorXd& q,
                                                    double tolerance = 1e-11);

/// Whether x is a solution. Rows may be off by `tolerance` times the largest |q| and by the
/// roundoff of their own terms, the signs of x by `tolerance` times the largest |x|.
[[nodiscard]] bool complementary(const Eigen::MatrixXd& W, const Eigen::VectorXd& q,
                                 const Eigen::VectorXd& x, double tolerance);

}  // namespace core
}  // namespace kairos
