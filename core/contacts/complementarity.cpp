#include "core/contacts/complementarity.hpp"

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

/// Solves W x = -q on the rows that are pressed; x is 0 elsewhere.
VectorXd on_rows(const MatrixXd& W, const VectorXd& q, const std::vector<Index>& pressed) {
  const auto n = static_cast<Index>(pressed.size());
  MatrixXd part(n, n);
  VectorXd right(n);
  for (Index i = 0; i < n; ++i) {
    const Index row = pressed[static_cast<std::size_t>(i)];
    right[i] = -q[row];
    for (Index k = 0; k < n; ++k) {
      part(i, k) = W(row, pressed[static_cast<std::size_t>(k)]);
    }
  }
  const VectorXd solution = least_norm(part, right);
  VectorXd x = VectorXd::Zero(q.size());
  for (Index i = 0; i < n; ++i) {
    x[pressed[static_cast<std::size_t>(i)]] = solution[i];
  }
  return x;
}

/// By row, the size below which W x + q counts as zero: `tolerance` of the largest q, and the
/// roundoff of its terms. Between bodies of very different masses the terms are far larger than
/// their sum.
VectorXd none(const MatrixXd& W, const VectorXd& q, const VectorXd& x, double tolerance) {
  constexpr double roundings = 64.0 * std::numeric_limits<double>::epsilon();
  const double rate = q.cwiseAbs().maxCoeff();
  return (roundings * (W.cwiseAbs() * x.cwiseAbs())).array() + tolerance * rate;
}

}  // namespace

bool complementary(const MatrixXd& W, const VectorXd& q, const VectorXd& x, double tolerance) {
  if (q.size() == 0) {
    return true;
  }
  const VectorXd rest = W * x + q;
  const double force = std::max(x.cwiseAbs().maxCoeff(), 0.0);
  const VectorXd least = none(W, q, x, tolerance);
  for (Index i = 0; i < q.size(); ++i) {
    const bool presses = x[i] > tolerance * force;
    if (x[i] < -tolerance * force || rest[i] < -least[i] || (presses && rest[i] > least[i])) {
      return false;
    }
  }
  return true;
}

Complementarity solve_complementarity(const MatrixXd& W, const VectorXd& q, double tolerance) {
  Complementarity answer{VectorXd::Zero(q.size()), false, 0};
  if (q.size() == 0 || q.minCoeff() >= 0.0) {
    answer.solved = true;
    return answer;
  }
  answer.x = least_norm(W, -q);
  ++answer.solves;
  if (answer.x.minCoeff() >= 0.0 && complementary(W, q, answer.x, tolerance)) {
    answer.solved = true;
    return answer;
  }
  answer.x.setZero();
  std::vector<Index> pressed;
  const auto most = static_cast<int>(3 * q.size() + 8);
  while (answer.solves < most) {
    const VectorXd rest = W * answer.x + q;
    const VectorXd doubt = none(W, q, answer.x, tolerance);
    Index enters = -1;
    for (Index i = 0; i < q.size(); ++i) {
      const bool is_in = std::find(pressed.begin(), pressed.end(), i) != pressed.end();
      if (!is_in && rest[i] < -doubt[i] && (enters < 0 || rest[i] < rest[enters])) {
        enters = i;
      }
    }
    if (enters < 0) {
      break;
    }
    pressed.push_back(enters);
    while (!pressed.empty() && answer.solves < most) {
      const VectorXd next = on_rows(W, q, pressed);
      ++answer.solves;
      // Goes towards the solution until some row would pull.
      double share = 1.0;
      for (const Index i : pressed) {
        if (next[i] <= 0.0) {
          share = std::min(share, answer.x[i] / (answer.x[i] - next[i]));
        }
      }
      if (share >= 1.0) {
        answer.x = next;
        break;
      }
      answer.x += std::max(share, 0.0) * (next - answer.x);
      const double least = tolerance * tolerance * answer.x.cwiseAbs().maxCoeff();
      std::erase_if(pressed, [&](Index i) { return next[i] <= 0.0 && answer.x[i] <= least; });
      for (Index i = 0; i < q.size(); ++i) {
        if (std::find(pressed.begin(), pressed.end(), i) == pressed.end()) {
          answer.x[i] = 0.0;
        }
      }
    }
  }
  answer.solved = complementary(W, q, answer.x, 16.0 * tolerance);
  return answer;
}

}  // namespace core
}  // namespace kairos
