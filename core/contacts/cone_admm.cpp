#include "core/contacts/cone_admm.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int most_rounds = 1500;
/// What is left is looked at after so many rounds, and so many looks that do not halve it end it.
constexpr int rounds_to_look = 10;
constexpr int most_idle = 8;
/// Of the largest eigenvalue: the first penalty, the least and the most, and the proximal term.
constexpr double first_penalty = 0.03;
constexpr double least_penalty = 1e-4;
constexpr double most_penalty = 1e2;
constexpr double proximal = 1e-8;
/// The penalty changes by this where impulses and rates are off by parts that differ as much.
constexpr double change = 3.0;
constexpr double differ = 10.0;
constexpr int power_steps = 16;
/// Pivots below this part of the largest one are roundoff of what others imply.
constexpr double implied = 1e-14;

/// A B with W = B B^T, of as few columns as it takes: bodies have six velocities each, and their
/// touches many rows. Cholesky's with pivots.
MatrixXd root(const MatrixXd& W) {
  VectorXd left = W.diagonal();
  const double least = implied * left.maxCoeff();
  MatrixXd B(W.rows(), W.rows());
  Index rank = 0;
  for (Index pivot = 0; rank < W.rows() && left.maxCoeff(&pivot) > least; ++rank) {
    const double size = std::sqrt(left[pivot]);
    B.col(rank) = (W.col(pivot) - B.leftCols(rank) * B.row(pivot).head(rank).transpose()) / size;
    left -= B.col(rank).cwiseAbs2();
    left[pivot] = 0.0;
  }
  return B.leftCols(rank);
}

/// Of a problem in units in which each touch by itself feels an impulse of 1 by 1 m/s.
class Admm {
 public:
  Admm(const ConeProblem& problem, const VectorXd& begin)
      : friction_(problem.friction), unit_(problem.q.size()) {
    for (Index at = 0; at < unit_.size(); at += 3) {
      const double felt = problem.W.diagonal().segment<3>(at).maxCoeff();
      unit_.segment<3>(at).setConstant(felt > 0.0 ? 1.0 / std::sqrt(felt) : 1.0);
    }
    const MatrixXd W = unit_.asDiagonal() * problem.W * unit_.asDiagonal();
    root_ = root(W);
    normal_ = root_.transpose().lazyProduct(root_);  // in an order that caches do not change
    q_ = unit_.cwiseProduct(problem.q);
    z_ = x_ = begin.cwiseQuotient(unit_);
    rates_ = W * z_ + q_;
    for (std::size_t touch = 0; touch < friction_.size(); ++touch) {
      rates_[3 * static_cast<Index>(touch)] += lifted(touch);
    }
    VectorXd some = VectorXd::Ones(normal_.rows());
    for (int k = 0; k < power_steps; ++k) {
      some = (normal_ * some.normalized()).eval();
    }
    largest_ = std::max(some.norm(), 1.0);
    decompose(first_penalty * largest_);
  }

  /// N s
  [[nodiscard]] VectorXd impulse() const { return unit_.cwiseProduct(z_); }

  void rounds(int count) {
    for (int k = 0; k < count; ++k) {
      VectorXd pulls = penalty_ * z_ + rates_ + proximal * largest_ * x_ - q_;
      for (std::size_t touch = 0; touch < friction_.size(); ++touch) {
        pulls[3 * static_cast<Index>(touch)] -= lifted(touch);
      }
      const VectorXd by_root = decomposition_.solve(root_.transpose() * pulls);
      x_ = (pulls - root_ * by_root) / shift_;
      before_ = z_;
      z_ = x_ - rates_ / penalty_;
      into_cones();
      rates_ -= penalty_ * (x_ - z_);
    }
  }

  void balance() {
    const double impulses = (x_ - z_).lpNorm<Eigen::Infinity>();
    const double rates = penalty_ * (z_ - before_).lpNorm<Eigen::Infinity>();
    if (impulses > differ * rates && penalty_ < most_penalty * largest_) {
      decompose(penalty_ * change);
    } else if (rates > differ * impulses && penalty_ > least_penalty * largest_) {
      decompose(penalty_ / change);
    }
  }

 private:
  /// Woodbury: (W + shift)^-1 v = (v - root (root^T root + shift)^-1 root^T v) / shift.
  void decompose(double penalty) {
    penalty_ = penalty;
    shift_ = penalty + proximal * largest_;
    MatrixXd K = normal_;
    K.diagonal().array() += shift_;
    decomposition_.compute(K);
  }

  /// What friction adds to the normal rate of a touch.
  [[nodiscard]] double lifted(std::size_t touch) const {
    const double mu = friction_[touch];
    const Index at = 3 * static_cast<Index>(touch);
    return std::isinf(mu) ? 0.0 : mu * rates_.segment<2>(at + 1).norm();
  }

  /// To the nearest impulses within the cones.
  void into_cones() {
    for (std::size_t touch = 0; touch < friction_.size(); ++touch) {
      const Index at = 3 * static_cast<Index>(touch);
      const double mu = friction_[touch];
      const double across = z_.segment<2>(at + 1).norm();
      if (std::isinf(mu)) {
        z_[at] = std::max(z_[at], 0.0);
      } else if (mu * across <= -z_[at]) {
        z_.segment<3>(at).setZero();
      } else if (across > mu * z_[at]) {
        const double normal = (z_[at] + mu * across) / (1.0 + mu * mu);
        z_[at] = normal;
        z_.segment<2>(at + 1) *= mu * normal / across;
      }
    }
  }

  const std::vector<double>& friction_;
  VectorXd unit_;
  MatrixXd root_;
  MatrixXd normal_;  ///< root^T root
  VectorXd q_;
  double largest_ = 0.0;  ///< eigenvalue, nearly
  double penalty_ = 0.0;
  double shift_ = 0.0;
  Eigen::LDLT<MatrixXd> decomposition_;
  VectorXd x_;       ///< impulses that go with the rates
  VectorXd z_;       ///< and such that are within the cones
  VectorXd before_;  ///< a round ago
  VectorXd rates_;   ///< the multipliers: rates, with what is added to the normal ones
};

/// Friction without a bound holds along the surfaces what nothing presses. What would part without
/// that has none from here on; whether some does.
bool let_part(const VectorXd& p, const ConeProblem& problem, std::vector<double>& friction) {
  const VectorXd u = problem.W * p + problem.q;
  bool any = false;
  for (std::size_t touch = 0; touch < friction.size() && !problem.holds_along; ++touch) {
    const Index at = 3 * static_cast<Index>(touch);
    if (std::isinf(friction[touch]) && p[at] == 0.0 && !p.segment<2>(at + 1).isZero(0.0) &&
        u[at] - problem.W.block<1, 3>(at, at).dot(p.segment<3>(at)) >= 0.0) {
      friction[touch] = 0.0;
      any = true;
    }
  }
  return any;
}

}  // namespace

ConeImpulses cone_admm(const ConeProblem& problem, const VectorXd& begin, double settled) {
  const ConeProjections projections(problem);
  const auto off = [&](const VectorXd& p) { return projections.off(p).lpNorm<Eigen::Infinity>(); };
  ConeImpulses nearest{begin, off(begin)};
  ConeProblem held = problem;
  bool again = true;
  while (again && nearest.off > settled) {
    Admm admm(held, begin);
    double least = std::numeric_limits<double>::infinity();
    VectorXd p = begin;
    for (int round = 0, idle = 0; round < most_rounds && idle < most_idle && nearest.off > settled;
         round += rounds_to_look, ++idle) {
      admm.rounds(rounds_to_look);
      p = admm.impulse();
      const double now = off(p);
      if (!std::isfinite(now)) {
        break;
      }
      if (now < 0.5 * least) {
        least = now;
        idle = 0;
      }
      if (now < nearest.off) {
        nearest = {p, now};
      }
      admm.balance();
    }
    again = nearest.off > settled && let_part(p, problem, held.friction);
  }
  projections.make_exact(nearest);
  return nearest;
}

}  // namespace core
}  // namespace kairos
