#include "core/contacts/cone_problem.hpp"

#include "core/contacts/body_system.hpp"
#include "core/contacts/least_norm.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace kairos {
inline namespace core {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

Eigen::Index place(std::size_t k) { return 3 * static_cast<Eigen::Index>(k); }

}  // namespace

ConeProblem held_near(const ConeProblem& problem, const VectorXd& p, const VectorXd& compliance) {
  ConeProblem held = problem;
  held.W.diagonal() += compliance;
  held.compliance =
      problem.compliance.size() > 0 ? VectorXd(problem.compliance + compliance) : compliance;
  held.q -= compliance.cwiseProduct(p);
  return held;
}

ConeProjections::ConeProjections(const ConeProblem& problem) : of_(problem) {
  for (std::size_t k = 0; k < of_.friction.size(); ++k) {
    const Eigen::Index at = place(k);
    felt_.push_back(of_.W.diagonal().segment<3>(at).maxCoeff());
  }
}

VectorXd ConeProjections::off(const VectorXd& p) const {
  const VectorXd u = of_.W * p + of_.q;
  VectorXd F(p.size());
  for (std::size_t k = 0; k < felt_.size(); ++k) {
    const Eigen::Index at = place(k);
    const Vector3d pk = p.segment<3>(at);
    const Vector3d uk = u.segment<3>(at);
    const Vector3d z = felt_[k] * pk - uk;
    switch (state(k, pk, uk, z)) {
      case Does::opens:
        F.segment<3>(at) = felt_[k] * pk;
        break;
      case Does::holds_along:
        F.segment<3>(at) << felt_[k] * pk[0], uk.tail<2>();
        break;
      case Does::sticks:
        F.segment<3>(at) = uk;
        break;
      case Does::slides:
        F[at] = uk[0];
        F.segment<2>(at + 1) =
            felt_[k] * pk.tail<2>() - of_.friction[k] * z[0] * z.tail<2>().normalized();
    }
  }
  return F;
}

std::vector<ConeProjections::Slope> ConeProjections::slopes(const VectorXd& p) const {
  const VectorXd u = of_.W * p + of_.q;
  std::vector<Slope> out;
  for (std::size_t k = 0; k < felt_.size(); ++k) {
    const Eigen::Index at = place(k);
    const Vector3d pk = p.segment<3>(at);
    const Vector3d z = felt_[k] * pk - u.segment<3>(at);
    const double mu = of_.friction[k];
    Slope slope;
    switch (state(k, pk, u.segment<3>(at), z)) {
      case Does::opens:
        slope.impulse.diagonal().setConstant(felt_[k]);
        break;
      case Does::holds_along:
        slope.impulse(0, 0) = felt_[k];
        slope.rates(1, 1) = slope.rates(2, 2) = 1.0;
        break;
      case Does::sticks:
        slope.rates.setIdentity();
        break;
      case Does::slides: {
        const double length = z.tail<2>().norm();
        const Vector2d d = z.tail<2>() / length;
        const Matrix2d turn = mu * z[0] / length * (Matrix2d::Identity() - d * d.transpose());
        slope.rates(0, 0) = 1.0;
        slope.rates.bottomLeftCorner<2, 1>() = mu * d;
        slope.rates.bottomRightCorner<2, 2>() = turn;
        slope.impulse.bottomLeftCorner<2, 1>() = -felt_[k] * mu * d;
        slope.impulse.bottomRightCorner<2, 2>() = felt_[k] * (Matrix2d::Identity() - turn);
      }
    }
    out.push_back(slope);
  }
  return out;
}

/// The derivative of `off`.
MatrixXd ConeProjections::change(const std::vector<Slope>& slopes) const {
  MatrixXd J(of_.q.size(), of_.q.size());
  for (std::size_t k = 0; k < slopes.size(); ++k) {
    const Eigen::Index at = place(k);
    J.middleRows<3>(at) = slopes[k].rates.lazyProduct(of_.W.middleRows<3>(at));
    J.block<3, 3>(at, at) += slopes[k].impulse;
  }
  return J;
}

std::optional<VectorXd> ConeProjections::step_by_bodies(const std::vector<Slope>& slopes,
                                                        const MatrixXd& J,
                                                        const VectorXd& F) const {
  if (of_.roots.empty() || of_.compliance.size() == 0) {
    return std::nullopt;
  }
  BodySystem bodies(of_.roots, VectorXd::Ones(F.size()));
  if (bodies.size() >= F.size()) {
    return std::nullopt;
  }
  std::vector<Matrix3d> inverse;
  std::vector<Matrix3d> rates;
  for (std::size_t k = 0; k < slopes.size(); ++k) {
    const Slope& slope = slopes[k];
    inverse.emplace_back((slope.impulse + of_.compliance[place(k)] * slope.rates).inverse());
    rates.push_back(slope.rates);
  }
  bodies.decompose(std::move(inverse), rates);
  constexpr double enough = 1e-10;
  return refined(J, F, enough, [&](const VectorXd& b) { return bodies.solve(b); });
}

VectorXd ConeProjections::newton_step(const VectorXd& p) const {
  const std::vector<Slope> of_touches = slopes(p);
  const MatrixXd J = change(of_touches);
  const VectorXd F = off(p);
  if (auto step = step_by_bodies(of_touches, J, F)) {
    return *std::move(step);
  }
  VectorXd step = VectorXd::Zero(F.size());
  // What opens has rows with nothing but an element of its own: it is known, and the others' system
  // is smaller without it.
  std::vector<Eigen::Index> left;
  for (Eigen::Index i = 0; i < F.size(); ++i) {
    if ((J.row(i).array() != 0.0).count() == 1 && J(i, i) != 0.0) {
      step[i] = F[i] / J(i, i);
    } else {
      left.push_back(i);
    }
  }
  if (!left.empty()) {
    const VectorXd rest = F - J * step;
    step(left) = least_norm(J(left, left), rest(left));
  }
  return step;
}

void ConeProjections::make_exact(ConeImpulses& nearest) const {
  VectorXd& p = nearest.impulse;
  const VectorXd u = of_.W * p + of_.q;
  for (std::size_t k = 0; k < felt_.size(); ++k) {
    const Eigen::Index at = place(k);
    const Vector3d pk = p.segment<3>(at);
    const Vector3d uk = u.segment<3>(at);
    const Does does = state(k, pk, uk, felt_[k] * pk - uk);
    if (does == Does::opens || does == Does::holds_along) {
      p[at] = 0.0;
    }
    p[at] = std::max(p[at], 0.0);
    const double most = of_.friction[k] * p[at];
    const double across = pk.tail<2>().norm();
    if (does == Does::opens || of_.friction[k] == 0.0) {
      p.segment<2>(at + 1).setZero();
    } else if (!std::isinf(of_.friction[k]) && across > most) {
      p.segment<2>(at + 1) *= most / across;
    }
  }
  nearest.off = off(p).lpNorm<Eigen::Infinity>();
}

bool ConeProjections::let_part(const VectorXd& p, std::vector<double>& friction) const {
  const VectorXd u = of_.W * p + of_.q;
  bool any = false;
  for (std::size_t k = 0; k < felt_.size(); ++k) {
    const Vector3d pk = p.segment<3>(place(k));
    const Vector3d uk = u.segment<3>(place(k));
    if (std::isinf(friction[k]) && !pk.tail<2>().isZero(0.0) &&
        state(k, pk, uk, felt_[k] * pk - uk) == Does::opens) {
      friction[k] = 0.0;
      any = true;
    }
  }
  return any;
}

ConeProjections::Does ConeProjections::state(std::size_t k, const Vector3d& p, const Vector3d& u,
                                             const Vector3d& z) const {
  const double mu = of_.friction[k];
  if (!(z[0] > 0.0)) {
    // Friction without a bound holds what would approach without it.
    const Eigen::Index at = place(k);
    const bool presses = u[0] - of_.W.block<1, 3>(at, at).dot(p) < 0.0;
    return std::isinf(mu) && (of_.holds_along || presses) ? Does::holds_along : Does::opens;
  }
  return std::isinf(mu) || z.tail<2>().norm() <= mu * z[0] ? Does::sticks : Does::slides;
}

}  // namespace core
}  // namespace kairos
