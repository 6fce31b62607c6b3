#include "core/contacts/cone_newton.hpp"

#include "core/contacts/least_norm.hpp"

#include <algorithm>
#include <cmath>

namespace kairos {
inline namespace core {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int most_steps = 30;
/// So many steps that do not halve what is left get no nearer.
constexpr int most_idle = 12;
/// Proximal points: the first compliance as a part of that of a touch, how it shrinks, how well a
/// problem with it must be solved, as a part of what is left, and how many there are.
constexpr double first_compliance = 0.1;
constexpr double shrink = 0.3;
constexpr double solved = 1e-2;
constexpr int most_rounds = 30;
/// So many that Newton's method does not solve get nowhere.
constexpr int most_unsolved = 3;
/// See `AtOnce::bounded`.
constexpr double nearly_rough = 100.0;

/// What impulses are off: zero where all is kept, m/s by touch, and how it changes with them.
class Projections {
 public:
  explicit Projections(const ConeProblem& problem) : of_(problem) {
    for (std::size_t k = 0; k < of_.friction.size(); ++k) {
      const Eigen::Index at = place(k);
      felt_.push_back(of_.W.diagonal().segment<3>(at).maxCoeff());
    }
  }

  [[nodiscard]] VectorXd off(const VectorXd& p) const {
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

  /// The derivative of `off`.
  [[nodiscard]] MatrixXd change(const VectorXd& p) const {
    const VectorXd u = of_.W * p + of_.q;
    MatrixXd J(p.size(), p.size());
    for (std::size_t k = 0; k < felt_.size(); ++k) {
      const Eigen::Index at = place(k);
      const Vector3d pk = p.segment<3>(at);
      const Vector3d z = felt_[k] * pk - u.segment<3>(at);
      auto rows = J.middleRows<3>(at);
      rows = of_.W.middleRows<3>(at);
      const auto keeps = [&](Eigen::Index r) {
        rows.row(r).setZero();
        rows(r, at + r) = felt_[k];
      };
      switch (state(k, pk, u.segment<3>(at), z)) {
        case Does::opens:
          keeps(0);
          keeps(1);
          keeps(2);
          break;
        case Does::holds_along:
          keeps(0);
          break;
        case Does::sticks:
          break;
        case Does::slides: {
          // d z = felt d p - W d p
          MatrixXd dz = -of_.W.middleRows<3>(at);
          dz.middleCols<3>(at).diagonal().array() += felt_[k];
          const double length = z.tail<2>().norm();
          const Vector2d d = z.tail<2>() / length;
          const Matrix2d turn =
              of_.friction[k] * z[0] / length * (Matrix2d::Identity() - d * d.transpose());
          rows.bottomRows<2>() = -of_.friction[k] * d * dz.row(0) - turn * dz.bottomRows<2>();
          rows(1, at + 1) += felt_[k];
          rows(2, at + 2) += felt_[k];
        }
      }
    }
    return J;
  }

  /// Into the cones, which the nearest may miss by what it is off: what opens takes no impulse at
  /// all, and what has no friction none across.
  void make_exact(ConeImpulses& nearest) const {
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

 private:
  enum class Does { opens, holds_along, sticks, slides };

  static Eigen::Index place(std::size_t k) { return 3 * static_cast<Eigen::Index>(k); }

  [[nodiscard]] Does state(std::size_t k, const Vector3d& p, const Vector3d& u,
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

  const ConeProblem& of_;
  std::vector<double> felt_;  ///< what an impulse does, 1/kg
};

}  // namespace

ConeImpulses cone_newton(const ConeProblem& problem, const VectorXd& begin, double settled) {
  const Projections projections(problem);
  ConeImpulses nearest{begin, projections.off(begin).lpNorm<Eigen::Infinity>()};
  for (VectorXd p : {begin, VectorXd(VectorXd::Zero(begin.size()))}) {
    for (int steps = 0, idle = 0; idle < most_idle && steps < most_steps && nearest.off > settled;
         ++steps, ++idle) {
      p -= least_norm(projections.change(p), projections.off(p));
      const double off = projections.off(p).lpNorm<Eigen::Infinity>();
      if (!std::isfinite(off)) {
        break;
      }
      if (off < nearest.off) {
        idle = off < 0.5 * nearest.off ? 0 : idle;
        nearest = {p, off};
      }
    }
  }
  projections.make_exact(nearest);
  return nearest;
}

ConeImpulses cone_proximal(const ConeProblem& problem, const VectorXd& begin, double settled) {
  const Projections projections(problem);
  const double scale = problem.W.diagonal().mean();
  const auto off = [&](const VectorXd& p) { return projections.off(p).lpNorm<Eigen::Infinity>(); };
  ConeImpulses nearest{begin, off(begin)};
  VectorXd p = VectorXd::Zero(begin.size());
  double here = off(p);
  double compliance = first_compliance * scale;
  for (int round = 0, unsolved = 0;
       round < most_rounds && unsolved < most_unsolved && nearest.off > settled; ++round) {
    ConeProblem with = problem;
    with.W.diagonal().array() += compliance;
    with.q -= compliance * p;
    const ConeImpulses found = cone_newton(with, p, 0.1 * settled);
    if (!(found.off <= solved * here)) {
      compliance *= 4.0;
      ++unsolved;
      continue;
    }
    p = found.impulse;
    const double now = off(p);
    compliance *= now < here ? shrink : 1.0;
    here = now;
    if (here < nearest.off) {
      nearest = {p, here};
    }
  }
  projections.make_exact(nearest);
  return nearest;
}

ConeImpulses cone_at_once(const ConeProblem& problem, const VectorXd& begin, double settled,
                          AtOnce way) {
  const auto is_rough = [](double mu) { return std::isinf(mu); };
  const bool rough = std::any_of(problem.friction.begin(), problem.friction.end(), is_rough);
  if (way == AtOnce::newton && problem.friction.size() <= most_for_newton) {
    return cone_newton(problem, begin, settled);
  }
  if (way == AtOnce::proximal) {
    return cone_proximal(problem, begin, settled);
  }
  if (way == AtOnce::bounded && rough) {
    ConeProblem bounded = problem;
    std::replace_if(bounded.friction.begin(), bounded.friction.end(), is_rough, nearly_rough);
    return cone_proximal(bounded, begin, settled);
  }
  if (way == AtOnce::held_along && rough) {
    ConeProblem held = problem;
    held.holds_along = true;
    const ConeImpulses found = cone_newton(held, begin, settled);
    return found.off <= settled ? found : cone_proximal(held, found.impulse, settled);
  }
  return {begin, Projections(problem).off(begin).lpNorm<Eigen::Infinity>()};
}

}  // namespace core
}  // namespace kairos
