#include "core/power_nodes.hpp"

#include "core/circular.hpp"

#include <Eigen/LU>

#include <cmath>

namespace kairos {
inline namespace core {

double PowerNodes::at(int k) { return 0.5 * (1.0 - cosine(M_PI * (2 * k + 1) / (2.0 * count))); }

Polynomial<3> PowerNodes::work(const Eigen::VectorXd& powers, double duration) {
  using Square = Eigen::Matrix<double, count, count>;
  Square monomials;
  for (int j = 0; j < count; ++j) {
    for (int k = 0; k < count; ++k) {
      monomials(j, k) = k == 0 ? 1.0 : monomials(j, k - 1) * at(j);
    }
  }
  const Eigen::VectorXd c = Eigen::PartialPivLU<Square>(monomials).solve(powers);
  Polynomial<3> work;
  work.resize(count);
  double scale = 1.0;
  for (int k = 0; k < count; ++k) {
    work[k + 1].x() = c[k] / ((k + 1) * scale);
    scale *= duration;
  }
  return work;
}

}  // namespace core
}  // namespace kairos
