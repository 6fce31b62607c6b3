// What `TurningForces` knows of forces at the edges of cones: which way what they hold begins to
// slide, and whether it stays.
#include "core/circular.hpp"
#include "core/contacts/turning_forces.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>

namespace kairos {
inline namespace core {
namespace {

using Does = FrictionChoice::Does;
using Eigen::Index;
using Eigen::VectorXd;

constexpr int most_turns = 30;
/// Accelerations of what begins to slide are along it, to this part of the largest load.
constexpr double aligned = 1e-15;
constexpr double nearly_aligned = 1e-12;

}  // namespace

TurningForces::Solution TurningForces::moved_by(std::span<const FrictionChoice> choices) {
  return solve(choices, of_several(Which::some));
}

VectorXd TurningForces::aside(std::span<const FrictionChoice> choices,
                              std::span<const std::size_t> begins) {
  const Solution found = moved_by(choices);
  VectorXd out(static_cast<Index>(begins.size()));
  for (std::size_t j = 0; j < begins.size(); ++j) {
    const std::size_t k = begins[j];
    const Vector3 side = now_[k].normal.cross(choices[k].direction);
    out[static_cast<Index>(j)] = side.dot(acceleration(k, found.accelerations)) / load_;
  }
  return out;
}

FrictionChoice TurningForces::turned_by(std::size_t touch, const FrictionChoice& choice,
                                        double angle) const {
  const Vector3& d = choice.direction;
  const Vector3 side = now_[touch].normal.cross(d);
  return {choice.does, (cosine(angle) * d + sine(angle) * side).normalized()};
}

/// The next step of Newton's method, by differences.
VectorXd TurningForces::angles_to_slip(std::span<const FrictionChoice> choices,
                                       std::span<const std::size_t> begins,
                                       const VectorXd& across) {
  constexpr double small = 1e-7;
  Eigen::MatrixXd slope(across.size(), across.size());
  for (std::size_t j = 0; j < begins.size(); ++j) {
    std::vector<FrictionChoice> turned(choices.begin(), choices.end());
    turned[begins[j]] = turned_by(begins[j], choices[begins[j]], small);
    slope.col(static_cast<Index>(j)) = (aside(turned, begins) - across) / small;
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(1e-9);
  decomposition.compute(slope);
  const VectorXd step = -decomposition.solve(across);
  return step * std::min(1.0, 1.0 / std::max(step.lpNorm<Eigen::Infinity>(), 1e-300));
}

bool TurningForces::turn_to_slip(std::vector<FrictionChoice>& choices) {
  std::vector<std::size_t> begins;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    if (choices[k].does == Does::begins) {
      begins.push_back(k);
    }
  }
  VectorXd across = aside(choices, begins);
  for (int turn = 0; turn < most_turns; ++turn) {
    if (across.lpNorm<Eigen::Infinity>() <= aligned) {
      break;
    }
    const VectorXd step = angles_to_slip(choices, begins, across);
    bool better = false;
    for (double share = 1.0; share > 1e-3 && !better; share *= 0.5) {
      std::vector<FrictionChoice> turned = choices;
      for (std::size_t j = 0; j < begins.size(); ++j) {
        const std::size_t k = begins[j];
        turned[k] = turned_by(k, choices[k], share * step[static_cast<Index>(j)]);
      }
      const VectorXd there = aside(turned, begins);
      better = there.norm() < across.norm();
      if (better) {
        choices = turned;
        across = there;
      }
    }
    if (!better) {
      break;
    }
  }
  return across.lpNorm<Eigen::Infinity>() <= nearly_aligned;
}

/// Whether forces at the edges of cones, of what sticks there, do the same. They are looked for as
/// if it slid: what others nearly hold as well asks for forces that a search among rays does not
/// tell from none.
bool TurningForces::held_at_edges(std::span<const FrictionChoice> choices, Solution& found,
                                  std::vector<std::size_t>* carry) {
  std::vector<FrictionChoice> edges(choices.begin(), choices.end());
  std::vector<std::size_t> at_edge;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (edges[k].does == Does::sticks && !edges[k].direction.isZero(0.0)) {
      const Vector3& n = now_[k].normal;
      const Vector3 along = edges[k].direction - n * n.dot(edges[k].direction);
      edges[k] = {Does::begins, along.normalized()};
      at_edge.push_back(k);
    }
  }
  if (at_edge.empty()) {
    return false;
  }
  if (!(aside(edges, at_edge).lpNorm<Eigen::Infinity>() <= turning_roundoff) &&
      !turn_to_slip(edges)) {
    return false;
  }
  const Solution there = verified(edges, {.carry = carry});
  double beyond = std::max(there.violation, there.residual);
  for (const std::size_t k : at_edge) {
    const Vector3& n = now_[k].normal;
    const Vector3 slips = acceleration(k, there.accelerations);
    beyond = std::max(beyond, (slips - n * n.dot(slips)).norm() / load_);
  }
  if (!(beyond <= turning_roundoff)) {
    return false;
  }
  found.force = there.force;
  found.violation = beyond;
  return true;
}

}  // namespace core
}  // namespace kairos
