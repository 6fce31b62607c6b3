#include "core/contacts/group_impacts.hpp"

#include "core/contacts/complementarity.hpp"
#include "core/contacts/least_norm.hpp"

#include <algorithm>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Most rounds of reflections; 200 random sets of 30 contacts took 9 at most.
constexpr int most_reflections = 200;
/// Rates below this part of the fastest one are roundoff of the solves before.
constexpr double at_rest = 1e-12;

/// The plastic impulse of the rows that approach; empty where none was found.
VectorXd plastic(const MatrixXd& W, const VectorXd& rates, double slow) {
  std::vector<Index> approaching;
  for (Index i = 0; i < rates.size(); ++i) {
    if (rates[i] < -slow) {
      approaching.push_back(i);
    }
  }
  const auto n = static_cast<Index>(approaching.size());
  MatrixXd part(n, n);
  VectorXd q(n);
  for (Index i = 0; i < n; ++i) {
    const Index row = approaching[static_cast<std::size_t>(i)];
    q[i] = rates[row];
    for (Index k = 0; k < n; ++k) {
      part(i, k) = W(row, approaching[static_cast<std::size_t>(k)]);
    }
  }
  const Complementarity solution = solve_complementarity(part, q);
  if (!solution.solved) {
    return {};
  }
  VectorXd impulse = VectorXd::Zero(rates.size());
  for (Index i = 0; i < n; ++i) {
    impulse[approaching[static_cast<std::size_t>(i)]] = solution.x[i];
  }
  return impulse;
}

/// Makes the rows that took an impulse leave at minus `returned`, up to the roundoff of a small
/// correction.
void polish(const ContactSystem& system, const VectorXd& returned, VectorXd& impulse,
            std::vector<Twist>& v) {
  ContactSystem active{system.bodies, {}, system.joints};
  std::vector<Index> place;
  for (Index i = 0; i < impulse.size(); ++i) {
    if (impulse[i] > 0.0) {
      active.rows.push_back(system.rows[static_cast<std::size_t>(i)]);
      place.push_back(i);
    }
  }
  if (place.empty()) {
    return;
  }
  const LeastNorm decomposition(active.coupling());
  for (int round = 0; round < 2; ++round) {
    VectorXd off = active.rates(v);
    for (Index k = 0; k < off.size(); ++k) {
      off[k] += returned[place[static_cast<std::size_t>(k)]];
    }
    const VectorXd more = decomposition.solve(-off);
    active.push(more, v);
    for (Index k = 0; k < off.size(); ++k) {
      impulse[place[static_cast<std::size_t>(k)]] += more[k];
    }
  }
}

}  // namespace

VectorXd newton_group(const ContactSystem& system, const VectorXd& restitution,
                      std::vector<Twist>& v) {
  const VectorXd before = system.rates(v);
  VectorXd q = before;
  for (Index i = 0; i < q.size(); ++i) {
    q[i] += restitution[i] * std::min(before[i], 0.0);
  }
  const Complementarity solution = solve_complementarity(system.coupling(), q);
  if (!solution.solved) {
    return {};
  }
  VectorXd impulse = solution.x;
  system.push(impulse, v);
  polish(system, q - before, impulse, v);
  return impulse;
}

VectorXd reflected_group(const ContactSystem& system, const VectorXd& restitution,
                         std::vector<Twist>& v) {
  const MatrixXd W = system.coupling();
  const VectorXd before = system.rates(v);
  const double slow = at_rest * before.cwiseAbs().maxCoeff();
  VectorXd reflected = VectorXd::Zero(before.size());
  VectorXd rates = before;
  for (int round = 0; rates.minCoeff() < -slow; ++round) {
    const VectorXd impulse = plastic(W, rates, slow);
    if (impulse.size() == 0 || round == most_reflections) {
      return {};
    }
    reflected += 2.0 * impulse;
    rates = before + W * reflected;
  }
  double e = 1.0;
  for (Index i = 0; i < before.size(); ++i) {
    e = reflected[i] > 0.0 ? std::min(e, restitution[i]) : e;
  }
  VectorXd impulse = reflected;
  if (e < 1.0) {
    const Complementarity all = solve_complementarity(W, before);
    if (!all.solved) {
      return {};
    }
    impulse = e * reflected + (1.0 - e) * all.x;
  }
  system.push(impulse, v);
  return impulse;
}

}  // namespace core
}  // namespace kairos
