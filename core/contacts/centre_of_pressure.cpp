#include "core/contacts/centre_of_pressure.hpp"

#include "core/contacts/nonnegative_solve.hpp"

#include <algorithm>

namespace kairos {
inline namespace core {

bool carries_at(const ContactManifold& patch, const Vector3& x) {
  const auto n = static_cast<Eigen::Index>(patch.size);
  Eigen::MatrixXd A(4, n);
  double extent = 0.0;
  for (Eigen::Index k = 0; k < n; ++k) {
    const Vector3 from = patch.points[static_cast<std::size_t>(k)].position - x;
    extent = std::max(extent, from.norm());
    A.col(k).head<3>() = from;
  }
  A.topRows(3) /= std::max(extent, 1e-300);
  A.row(3).setOnes();
  const Eigen::VectorXd b = Eigen::Vector4d(0.0, 0.0, 0.0, 1.0);
  return solve_nonnegative(A, b, 0).residual <= 1e-9;
}

}  // namespace core
}  // namespace kairos
