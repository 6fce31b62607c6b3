#include "core/contacts/nonnegative_solve.hpp"

#include "core/contacts/least_norm.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

VectorXd on_columns(const MatrixXd& A, const VectorXd& b, const std::vector<Index>& columns) {
  MatrixXd part(A.rows(), static_cast<Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    part.col(static_cast<Index>(k)) = A.col(columns[k]);
  }
  return least_norm(part, b);
}

}  // namespace

NonnegativeSolution solve_nonnegative(const MatrixXd& A, const VectorXd& b, Index free) {
  NonnegativeSolution answer{VectorXd::Zero(A.cols()), 0.0, 0};
  std::vector<Index> active;
  for (Index j = 0; j < free; ++j) {
    active.push_back(j);
  }
  if (free > 0) {
    answer.x.head(free) = on_columns(A, b, active);
    ++answer.solves;
  }
  const double scale = b.size() > 0 ? b.cwiseAbs().maxCoeff() : 0.0;
  const auto most = static_cast<int>(3 * A.cols() + 8);
  std::vector<char> tried(static_cast<std::size_t>(A.cols()), 0);
  while (answer.solves < most) {
    const VectorXd rest = b - A * answer.x;
    if (rest.size() == 0 || rest.cwiseAbs().maxCoeff() <= 4.0 * epsilon * scale) {
      break;
    }
    Index enters = -1;
    double steepest = 0.0;
    for (Index j = free; j < A.cols(); ++j) {
      const double slope = A.col(j).dot(rest) / std::max(A.col(j).norm(), 1e-300);
      const bool is_in = std::find(active.begin(), active.end(), j) != active.end();
      if (!is_in && tried[static_cast<std::size_t>(j)] == 0 && slope > steepest) {
        steepest = slope;
        enters = j;
      }
    }
    if (enters < 0 || steepest <= 1e-13 * scale) {
      break;
    }
    active.push_back(enters);
    bool first = true;
    while (answer.solves < most) {
      const VectorXd next = on_columns(A, b, active);
      ++answer.solves;
      if (first && next[next.size() - 1] <= 0.0) {  // only roundoff called it in
        tried[static_cast<std::size_t>(enters)] = 1;
        active.pop_back();
        break;
      }
      if (first) {
        std::fill(tried.begin(), tried.end(), char{0});
      }
      first = false;
      double share = 1.0;
      for (std::size_t k = static_cast<std::size_t>(free); k < active.size(); ++k) {
        const double to = next[static_cast<Index>(k)];
        const double from = answer.x[active[k]];
        share = to <= 0.0 ? std::min(share, from / (from - to)) : share;
      }
      for (std::size_t k = 0; k < active.size(); ++k) {
        double& x = answer.x[active[k]];
        x += share * (next[static_cast<Index>(k)] - x);
      }
      if (share >= 1.0) {
        break;
      }
      const double least = 4.0 * epsilon * answer.x.cwiseAbs().maxCoeff();
      for (std::size_t k = active.size(); k-- > static_cast<std::size_t>(free);) {
        if (next[static_cast<Index>(k)] <= 0.0 && answer.x[active[k]] <= least) {
          answer.x[active[k]] = 0.0;
          active.erase(active.begin() + static_cast<std::ptrdiff_t>(k));
        }
      }
    }
  }
  if (b.size() > 0) {
    answer.residual = (b - A * answer.x).cwiseAbs().maxCoeff();
  }
  return answer;
}

}  // namespace core
}  // namespace kairos
