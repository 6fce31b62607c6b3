// `ContactSweeps` where impulses are looked for at all touches at once.
#include "core/contacts/contact_sweeps.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include <algorithm>
#include <cmath>

namespace kairos {
inline namespace core {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

/// Friction within this part of its bound is at its bound.
constexpr double at_bound = 1e-9;
/// Redundant touches make a system singular. It is solved with this part of the largest coupling
/// added to its diagonal, again and again for what is left: what has no answer, as touches
/// contradict each other by roundoff, then grows no impulse.
constexpr double damping = 1e-4;
constexpr int most_rounds = 40;

/// What an impulse at a touch may be, along `gives`, and what it is to bring to rest, along `asks`.
struct Unknown {
  Vector3 asks;
  Vector3 gives;
  double compliance = 0.0;  ///< 1/kg: `asks` is to be at minus this times the unknown
};

/// Solves K x = b with this added to the diagonal, as `damping` says; `off` is what is left. False:
/// it cannot.
bool solve_damped(const Sparse& K, double added, const VectorXd& b, VectorXd& x, double& off) {
  Sparse damped = K;
  for (Index i = 0; i < K.rows(); ++i) {
    damped.coeffRef(i, i) += added;
  }
  damped.makeCompressed();
  const Eigen::SparseLU<Sparse> decomposition(damped);
  if (decomposition.info() != Eigen::Success) {
    return false;
  }
  x = VectorXd::Zero(b.size());
  VectorXd rest = b;
  off = rest.lpNorm<Eigen::Infinity>();
  for (int round = 0; round < most_rounds; ++round) {
    const VectorXd more = decomposition.solve(rest);
    rest = b - K * (x + more);
    const double now = rest.lpNorm<Eigen::Infinity>();
    if (!(now < off)) {
      break;
    }
    x += more;
    const bool slow = now > 0.5 * off;
    off = now;
    if (slow) {
      break;
    }
  }
  return x.allFinite();
}

}  // namespace

Matrix3 ContactSweeps::coupling(std::size_t asks, std::size_t gives) const {
  const Block& of = blocks_[asks];
  const Block& to = blocks_[gives];
  if (joints_ != nullptr) {
    return between(of, to);
  }
  Matrix3 W = Matrix3::Zero();
  if (of.a == to.a) W += of.of_a * to.to_a;
  if (of.a == to.b) W += of.of_a * to.to_b;
  if (of.b == to.a) W += of.of_b * to.to_a;
  if (of.b == to.b) W += of.of_b * to.to_b;
  return W;
}

/// Goes to the nearest that is found at all touches at once from here on, and returns how far it is
/// off, m/s.
double ContactSweeps::settle_at_once(const std::vector<Vector6>& free,
                                     std::span<const Vector3> rates, double settled, bool rubs,
                                     AtOnce way, std::vector<Vector3>& along,
                                     std::vector<Vector6>& velocities) const {
  std::vector<std::size_t> touches;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    if (blocks_[k].presses()) {
      touches.push_back(k);
    }
  }
  const std::size_t n = touches.size();
  const auto size = static_cast<Index>(3 * n);
  ConeProblem problem{Eigen::MatrixXd(size, size), VectorXd(size), {}};
  VectorXd begin(size);
  for (std::size_t k = 0; k < n; ++k) {
    const auto at = static_cast<Index>(3 * k);
    const Block& block = blocks_[touches[k]];
    problem.q.segment<3>(at) = rate_of(touches[k], free, rates);
    problem.friction.push_back(rubs ? block.friction : 0.0);
    begin.segment<3>(at) = along[touches[k]];
    if (joints_ == nullptr) {
      problem.roots.push_back({block.a, block.b, block.root_a, block.root_b});
    }
    for (std::size_t l = 0; l < n; ++l) {
      problem.W.block<3, 3>(at, static_cast<Index>(3 * l)) = coupling(touches[k], touches[l]);
    }
  }
  if (joints_ != nullptr) {
    problem.W = (0.5 * (problem.W + problem.W.transpose())).eval();
  }
  const ConeImpulses found = cone_at_once(problem, begin, settled, way);
  velocities = free;
  for (std::size_t k = 0; k < n; ++k) {
    along[touches[k]] = found.impulse.segment<3>(static_cast<Index>(3 * k));
  }
  push_all(along, velocities);
  return found.off;
}

/// Goes to the impulses with which each touch goes on doing what it does: one that nothing presses
/// parts, one within its cone sticks, one at its bound slides against its friction, whose direction
/// follows that of the slip to first order: one step of Newton's method [AlartCurnier1991].
/// @param anew  impulses from none, so that redundant touches share alike; otherwise as near to
///              those found as it is
/// @returns by how much touches that are redundant contradict each other, m/s
double ContactSweeps::solve_as_found(const std::vector<Vector6>& free,
                                     std::span<const Vector3> rates, bool rubs, bool anew,
                                     std::vector<Vector3>& along,
                                     std::vector<Vector6>& velocities) const {
  const std::size_t n = blocks_.size();
  std::vector<Unknown> unknowns;
  std::vector<std::size_t> first;  // by touch
  for (std::size_t k = 0; k < n; ++k) {
    const Vector3& p = along[k];
    const double mu = rubs ? blocks_[k].friction : 0.0;
    const double bound = mu * p.x();
    const double rubbed = p.tail<2>().norm();
    first.push_back(unknowns.size());
    if (!(p.x() > 0.0) && !(std::isinf(mu) && !p.isZero(0.0))) {
      continue;
    }
    if (mu > 0.0 && !(rubbed >= bound * (1.0 - at_bound))) {
      for (int axis = 0; axis < 3; ++axis) {
        unknowns.push_back({Vector3::Unit(axis), Vector3::Unit(axis)});
      }
    } else if (mu > 0.0 && std::isfinite(mu) && rubbed > 0.0) {
      const Vector3 d(0.0, p.y() / rubbed, p.z() / rubbed);
      const Vector3 across(0.0, -d.z(), d.y());
      const double slip = rate_of(k, velocities, rates).tail<2>().norm();
      unknowns.push_back({Vector3::UnitX(), Vector3::UnitX() + mu * d});
      unknowns.push_back({across, across, slip / rubbed});
    } else {
      unknowns.push_back({Vector3::UnitX(), Vector3::UnitX()});
    }
  }
  first.push_back(unknowns.size());
  if (unknowns.empty()) {
    return 0.0;
  }
  const std::vector<Vector6>& from = anew ? free : velocities;
  const auto size = static_cast<Index>(unknowns.size());
  VectorXd asked(size);
  std::vector<Eigen::Triplet<double>> entries;
  double largest = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const Vector3 u = rate_of(k, from, rates);
    for (std::size_t r = first[k]; r < first[k + 1]; ++r) {
      asked[static_cast<Index>(r)] = -unknowns[r].asks.dot(u);
      entries.emplace_back(static_cast<int>(r), static_cast<int>(r), unknowns[r].compliance);
    }
    for (std::size_t l = 0; l < n && first[k] < first[k + 1]; ++l) {
      const Matrix3 W = coupling(k, l);
      for (std::size_t r = first[k]; r < first[k + 1] && !W.isZero(0.0); ++r) {
        for (std::size_t c = first[l]; c < first[l + 1]; ++c) {
          const double w = unknowns[r].asks.dot(W * unknowns[c].gives);
          largest = std::max(largest, std::abs(w));
          entries.emplace_back(static_cast<int>(r), static_cast<int>(c), w);
        }
      }
    }
  }
  Sparse K(size, size);
  K.setFromTriplets(entries.begin(), entries.end());
  VectorXd x;
  double off = 0.0;
  if (!solve_damped(K, damping * largest, asked, x, off)) {
    return 0.0;
  }
  for (std::size_t k = 0; k < n; ++k) {
    Vector3 more = Vector3::Zero();
    for (std::size_t c = first[k]; c < first[k + 1]; ++c) {
      more += x[static_cast<Index>(c)] * unknowns[c].gives;
    }
    along[k] = anew ? more : Vector3(along[k] + more);
  }
  velocities = free;
  push_all(along, velocities);
  return off;
}

}  // namespace core
}  // namespace kairos
