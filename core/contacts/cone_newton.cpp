#include "core/contacts/cone_newton.hpp"

#include "core/contacts/cone_interior.hpp"
#include "core/contacts/least_norm.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

using Eigen::VectorXd;

constexpr double infinity = std::numeric_limits<double>::infinity();
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
/// `cone_compliant`: the compliance as a part of what each touch feels by itself, those that lead
/// there where Newton's method goes round in a circle, and how many problems there are.
constexpr double least_part = 1e-7;
constexpr std::array leading_parts = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, least_part};
constexpr int most_compliant = 3;
/// What slides so many times faster than the others goes on; what is slower than this part of the
/// fastest is at rest.
constexpr double much_faster = 1e3;
constexpr double at_rest = 1e-12;
/// See `AtOnce::bounded`.
constexpr double nearly_rough = 100.0;

/// Impulses to begin with. What friction jams, as a wedge, has far larger ones than what it began
/// with.
enum class Start { given, nothing, all_stick, slow_stick };

/// Impulses with which what slides much faster than the others slides on, and these stick; none
/// where nothing does. Where friction jams the others they are not found from where all stick,
/// which would stop what is fast.
VectorXd slow_stick(const ConeProblem& problem) {
  const std::size_t touches = problem.friction.size();
  const auto slip = [&](std::size_t k) -> Eigen::Vector2d {
    return problem.q.segment<2>(static_cast<Eigen::Index>(3 * k + 1));
  };
  std::vector<double> speeds;
  for (std::size_t k = 0; k < touches; ++k) {
    speeds.push_back(slip(k).norm());
  }
  std::sort(speeds.begin(), speeds.end());
  double fast = infinity;
  double widest = much_faster;
  for (std::size_t k = 1; k < touches; ++k) {
    const double ratio = speeds[k] / std::max(speeds[k - 1], at_rest * speeds.back());
    if (ratio > widest) {
      widest = ratio;
      fast = speeds[k];
    }
  }
  if (std::isinf(fast)) {
    return VectorXd::Zero(problem.q.size());
  }
  std::vector<Eigen::Index> held;  // rates that are to be zero
  Eigen::MatrixXd gives = Eigen::MatrixXd::Identity(problem.q.size(), problem.q.size());
  for (std::size_t k = 0; k < touches; ++k) {
    const auto at = static_cast<Eigen::Index>(3 * k);
    held.push_back(at);
    if (slip(k).norm() < fast || std::isinf(problem.friction[k])) {
      held.insert(held.end(), {at + 1, at + 2});
    } else {
      gives.block<2, 1>(at + 1, at) = -problem.friction[k] * slip(k).normalized();
    }
  }
  const Eigen::MatrixXd shares = gives(Eigen::seqN(0, gives.rows()), held);
  const Eigen::MatrixXd rates = problem.W * shares;
  return shares * least_norm(rates(held, Eigen::seqN(0, rates.cols())), -problem.q(held));
}

/// The impulses that came nearest from these starts, one after the other.
ConeImpulses newton_from(std::initializer_list<Start> starts, const ConeProblem& problem,
                         const VectorXd& begin, double settled) {
  const ConeProjections projections(problem);
  ConeImpulses nearest{begin, projections.off(begin).lpNorm<Eigen::Infinity>()};
  for (const Start start : starts) {
    VectorXd p = start == Start::given ? begin : VectorXd(VectorXd::Zero(begin.size()));
    if (start == Start::all_stick && nearest.off > settled) {
      p = least_norm(problem.W, -problem.q);
    } else if (start == Start::slow_stick && nearest.off > settled) {
      p = slow_stick(problem);
      if (p.isZero(0.0)) {
        continue;
      }
    }
    for (int steps = 0, idle = 0; idle < most_idle && steps < most_steps && nearest.off > settled;
         ++steps, ++idle) {
      p -= projections.newton_step(p);
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

}  // namespace

ConeImpulses cone_newton(const ConeProblem& problem, const VectorXd& begin, double settled) {
  return newton_from({Start::given, Start::nothing, Start::all_stick, Start::slow_stick}, problem,
                     begin, settled);
}

ConeImpulses cone_proximal(const ConeProblem& problem, const VectorXd& begin, double settled) {
  const ConeProjections projections(problem);
  const double scale = problem.W.diagonal().mean();
  const auto off = [&](const VectorXd& p) { return projections.off(p).lpNorm<Eigen::Infinity>(); };
  ConeImpulses nearest{begin, off(begin)};
  VectorXd p = VectorXd::Zero(begin.size());
  double here = off(p);
  VectorXd compliance = VectorXd::Constant(p.size(), first_compliance * scale);
  for (int round = 0, unsolved = 0;
       round < most_rounds && unsolved < most_unsolved && nearest.off > settled; ++round) {
    const ConeImpulses found = newton_from({Start::given, Start::nothing},
                                           held_near(problem, p, compliance), p, 0.1 * settled);
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

ConeImpulses cone_compliant(const ConeProblem& problem, const VectorXd& begin, double settled) {
  const ConeProjections projections(problem);
  ConeImpulses nearest{begin, infinity};
  VectorXd felt(begin.size());
  for (Eigen::Index at = 0; at < begin.size(); at += 3) {
    felt.segment<3>(at).setConstant(problem.W.diagonal().segment<3>(at).maxCoeff());
  }
  VectorXd p = VectorXd::Zero(begin.size());
  for (int round = 0; round < most_compliant && !(nearest.off <= settled); ++round) {
    const auto solve = [&](double part, const VectorXd& from) {
      return newton_from({Start::given}, held_near(problem, p, part * felt), from, settled);
    };
    ConeImpulses found = solve(least_part, round == 0 ? begin : p);
    if (!(found.off <= settled) && round == 0) {
      found = {begin, 0.0};
      for (std::size_t i = 0; i < leading_parts.size() && found.off <= settled; ++i) {
        found = solve(leading_parts[i], found.impulse);
      }
    }
    if (!(found.off <= settled)) {
      break;
    }
    p = std::move(found.impulse);
    const double off = projections.off(p).lpNorm<Eigen::Infinity>();
    if (off < nearest.off) {
      nearest = {p, off};
    }
  }
  if (!std::isfinite(nearest.off)) {
    return nearest;
  }
  bool nearer = true;
  while (nearer && nearest.off > settled) {
    VectorXd next = nearest.impulse - projections.newton_step(nearest.impulse);
    const double off = projections.off(next).lpNorm<Eigen::Infinity>();
    nearer = off < 0.5 * nearest.off;
    if (nearer) {
      nearest = {std::move(next), off};
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
  if (way == AtOnce::compliant) {
    const ConeImpulses found = problem.friction.size() <= most_for_newton
                                   ? newton_from({Start::given}, problem, begin, settled)
                                   : ConeImpulses{begin, infinity};
    return found.off <= settled ? found : cone_compliant(problem, begin, settled);
  }
  if (way == AtOnce::interior) {
    return cone_interior(problem, begin, settled);
  }
  const bool few = problem.friction.size() <= most_for_proximal;
  if (way == AtOnce::proximal && few) {
    return cone_proximal(problem, begin, settled);
  }
  if (way == AtOnce::bounded && rough && few) {
    ConeProblem bounded = problem;
    std::replace_if(bounded.friction.begin(), bounded.friction.end(), is_rough, nearly_rough);
    return cone_proximal(bounded, begin, settled);
  }
  if (way == AtOnce::held_along && rough) {
    ConeProblem held = problem;
    held.holds_along = true;
    const ConeImpulses found =
        few ? cone_newton(held, begin, settled) : ConeImpulses{begin, infinity};
    return found.off <= settled ? found : cone_interior(held, found.impulse, settled);
  }
  return {begin, ConeProjections(problem).off(begin).lpNorm<Eigen::Infinity>()};
}

}  // namespace core
}  // namespace kairos
