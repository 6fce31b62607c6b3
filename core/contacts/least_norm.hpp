#pragma once

#include <Eigen/Core>

#include <memory>

namespace kairos {
inline namespace core {

/// Solves A x = b in the sense of least squares, with the x of least norm, for one A and any number
/// of b: a complete orthogonal decomposition. Columns and rows that
/// the others imply up to 1e-12 count as implied.
class LeastNorm {
 public:
  explicit LeastNorm(const Eigen::MatrixXd& A);
  ~LeastNorm();

  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  struct Decomposition;
  std::unique_ptr<const Decomposition> decomposition_;
};

/// The x of least norm that minimises |A x - b|, as `LeastNorm`; the residual of ill-scaled rows is
/// solved for once more.
[[nodiscard]] Eigen::VectorXd least_norm(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// Columns that are an orthonormal basis of all x with A x = 0, where rows that the others imply up
/// to 1e-12 count as implied.
[[nodiscard]] Eigen::MatrixXd null_space(const Eigen::MatrixXd& A);

}  // namespace core
}  // namespace kairos
