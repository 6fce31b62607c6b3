#pragma once

#include <Eigen/Core>

namespace kairos {
inline namespace core {

/// The x of least norm that minimises |A x - b|, by a complete orthogonal decomposition.
/// Columns and rows that the others imply up to 1e-12 count as implied; the residual of ill-scaled
/// rows is solved for once more.
[[nodiscard]] Eigen::VectorXd least_norm(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace core
}  // namespace kairos
