#include "core/contacts/least_norm.hpp"

#include <Eigen/QR>

namespace kairos {
inline namespace core {
namespace {

constexpr double rank_threshold = 1e-12;

}  // namespace

struct LeastNorm::Decomposition : Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> {
  explicit Decomposition(const Eigen::MatrixXd& A) {
    setThreshold(rank_threshold);
    compute(A);
  }
};

LeastNorm::LeastNorm(const Eigen::MatrixXd& A)
    : decomposition_(std::make_unique<const Decomposition>(A)) {}
LeastNorm::~LeastNorm() = default;

Eigen::VectorXd LeastNorm::solve(const Eigen::VectorXd& b) const {
  return decomposition_->solve(b);
}

Eigen::VectorXd least_norm(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  const LeastNorm decomposition(A);
  Eigen::VectorXd x = decomposition.solve(b);
  x += decomposition.solve(b - A * x);
  return x;
}

Eigen::MatrixXd null_space(const Eigen::MatrixXd& A) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(rank_threshold);
  decomposition.compute(A.transpose());
  const Eigen::MatrixXd all =
      decomposition.householderQ() * Eigen::MatrixXd::Identity(A.cols(), A.cols());
  return all.rightCols(A.cols() - decomposition.rank());
}

}  // namespace core
}  // namespace kairos
