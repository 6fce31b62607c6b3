#include "core/contacts/nonnegative_solve.hpp"

#include "core/contacts/least_norm.hpp"

#include <Eigen/Jacobi>
#include <Eigen/QR>

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
/// A column of which others imply all but this part is implied.
constexpr double implied = 1e-12;

/// Columns that may come and go, as Q R with orthonormal Q: Gram-Schmidt, twice [Daniel1976].
class Factors {
 public:
  Factors(Index rows, Index most) : Q_(rows, most), R_(MatrixXd::Zero(most, most)) {}

  /// Takes another column; false, and nothing has changed, if those that there are imply it.
  bool append(VectorXd column) {
    const double length = column.norm();
    if (n_ == Q_.cols()) {
      return false;
    }
    VectorXd along = VectorXd::Zero(n_);
    for (int pass = 0; pass < 2; ++pass) {
      const VectorXd part = Q_.leftCols(n_).transpose() * column;
      column.noalias() -= Q_.leftCols(n_) * part;
      along += part;
    }
    const double left = column.norm();
    if (!(left > implied * length)) {
      return false;
    }
    R_.col(n_).head(n_) = along;
    R_(n_, n_) = left;
    Q_.col(n_) = column / left;
    ++n_;
    return true;
  }

  /// Columns behind the one that goes move up.
  void remove(Index column) {
    for (Index k = column; k + 1 < n_; ++k) {
      R_.col(k).head(k + 2) = R_.col(k + 1).head(k + 2);
    }
    --n_;
    for (Index k = column; k < n_; ++k) {
      Eigen::JacobiRotation<double> rotation;
      rotation.makeGivens(R_(k, k), R_(k + 1, k));
      R_.middleCols(k, n_ - k).applyOnTheLeft(k, k + 1, rotation.adjoint());
      Q_.applyOnTheRight(k, k + 1, rotation);
      R_(k + 1, k) = 0.0;
    }
    R_.col(n_).setZero();
  }

  /// The part of b that these columns do not make.
  [[nodiscard]] VectorXd rest(VectorXd b) const {
    for (int pass = 0; pass < 2; ++pass) {
      b -= Q_.leftCols(n_) * (Q_.leftCols(n_).transpose() * b);
    }
    return b;
  }

  [[nodiscard]] VectorXd solve(const VectorXd& b) const {
    return R_.topLeftCorner(n_, n_).triangularView<Eigen::Upper>().solve(
        Q_.leftCols(n_).transpose() * b);
  }

 private:
  MatrixXd Q_;  ///< the first n_ columns count, as of R_
  MatrixXd R_;
  Index n_ = 0;
};

/// What the first columns leave of the others, which they may imply, and of b.
void project_out(Index first, MatrixXd& A, VectorXd& b) {
  if (first == 0) {
    return;
  }
  Eigen::ColPivHouseholderQR<MatrixXd> decomposition;
  decomposition.setThreshold(implied);
  decomposition.compute(A.leftCols(first));
  const MatrixXd Q =
      decomposition.householderQ() * MatrixXd::Identity(A.rows(), decomposition.rank());
  A = A.rightCols(A.cols() - first).eval();
  const VectorXd lengths = A.colwise().norm();
  for (int pass = 0; pass < 2; ++pass) {
    A -= Q * (Q.transpose() * A);
    b -= Q * (Q.transpose() * b);
  }
  for (Index j = 0; j < A.cols(); ++j) {
    if (!(A.col(j).norm() > implied * lengths[j])) {
      A.col(j).setZero();
    }
  }
}

/// The columns of A that a nonnegative least-squares solution takes.
std::vector<Index> columns_taken(const MatrixXd& A, const VectorXd& b, double scale, int& solves) {
  std::vector<Index> active;
  std::vector<char> is_in(static_cast<std::size_t>(A.cols()), 0);
  std::vector<char> tried(static_cast<std::size_t>(A.cols()), 0);
  VectorXd x = VectorXd::Zero(A.cols());
  Factors factors(A.rows(), std::min(A.rows(), A.cols()));
  const VectorXd lengths = A.colwise().norm();
  const int most = solves + static_cast<int>(3 * A.cols() + 8);
  while (solves < most) {
    const VectorXd rest = factors.rest(b);
    if (rest.size() == 0 || rest.cwiseAbs().maxCoeff() <= 4.0 * epsilon * scale) {
      break;
    }
    const VectorXd slopes = A.transpose() * rest;
    Index enters = -1;
    double steepest = 1e-13 * scale;
    for (Index j = 0; j < A.cols(); ++j) {
      const auto k = static_cast<std::size_t>(j);
      const double slope = slopes[j] / std::max(lengths[j], 1e-300);
      if (is_in[k] == 0 && tried[k] == 0 && slope > steepest) {
        steepest = slope;
        enters = j;
      }
    }
    if (enters < 0) {
      break;
    }
    const auto entered = static_cast<std::size_t>(enters);
    tried[entered] = 1;
    if (!factors.append(A.col(enters))) {
      continue;
    }
    active.push_back(enters);
    is_in[entered] = 1;
    for (bool first = true; solves < most; first = false) {
      const VectorXd next = factors.solve(b);
      ++solves;
      if (first && next[next.size() - 1] <= 0.0) {  // only roundoff called it in
        active.pop_back();
        is_in[entered] = 0;
        factors.remove(next.size() - 1);
        break;
      }
      if (first) {
        std::fill(tried.begin(), tried.end(), char{0});
      }
      double share = 1.0;
      for (std::size_t k = 0; k < active.size(); ++k) {
        const double to = next[static_cast<Index>(k)];
        const double from = x[active[k]];
        share = to <= 0.0 ? std::min(share, from / (from - to)) : share;
      }
      for (std::size_t k = 0; k < active.size(); ++k) {
        x[active[k]] += share * (next[static_cast<Index>(k)] - x[active[k]]);
      }
      if (share >= 1.0) {
        break;
      }
      const double least = 4.0 * epsilon * x.cwiseAbs().maxCoeff();
      for (std::size_t k = active.size(); k-- > 0;) {
        if (next[static_cast<Index>(k)] <= 0.0 && x[active[k]] <= least) {
          x[active[k]] = 0.0;
          is_in[static_cast<std::size_t>(active[k])] = 0;
          active.erase(active.begin() + static_cast<std::ptrdiff_t>(k));
          factors.remove(static_cast<Index>(k));
        }
      }
    }
  }
  return active;
}

}  // namespace

NonnegativeSolution solve_nonnegative(const MatrixXd& A, const VectorXd& b, Index free) {
  NonnegativeSolution answer{VectorXd::Zero(A.cols()), 0.0, 0};
  const double scale = b.size() > 0 ? b.cwiseAbs().maxCoeff() : 0.0;
  MatrixXd others = A;
  VectorXd rest = b;
  project_out(free, others, rest);
  std::vector<Index> columns = columns_taken(others, rest, scale, answer.solves);
  std::sort(columns.begin(), columns.end());
  MatrixXd part(A.rows(), free + static_cast<Index>(columns.size()));
  part.leftCols(free) = A.leftCols(free);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    part.col(free + static_cast<Index>(k)) = A.col(free + columns[k]);
  }
  if (part.cols() > 0) {
    const VectorXd taken = least_norm(part, b);
    ++answer.solves;
    answer.x.head(free) = taken.head(free);
    for (std::size_t k = 0; k < columns.size(); ++k) {  // what is hardly taken may be below zero
      answer.x[free + columns[k]] = std::max(0.0, taken[free + static_cast<Index>(k)]);
    }
  }
  if (b.size() > 0) {
    answer.residual = (b - A * answer.x).cwiseAbs().maxCoeff();
  }
  return answer;
}

}  // namespace core
}  // namespace kairos
