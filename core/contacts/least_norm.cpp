#include "core/contacts/least_norm.hpp"

#include <Eigen/QR>

namespace kairos {
inline namespace core {

Eigen::VectorXd least_norm(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(1e-12);
  decomposition.compute(A);
  Eigen::VectorXd x = decomposition.solve(b);
  x += decomposition.solve(b - A * x);
  return x;
}

}  // namespace core
}  // namespace kairos
