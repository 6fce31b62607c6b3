// What `TurningForces` proposes that touches do. Nothing of it is accepted that is not verified.
#include "core/circular.hpp"
#include "core/contacts/complementarity.hpp"
#include "core/contacts/contact_sweeps.hpp"
#include "core/contacts/nonnegative_solve.hpp"
#include "core/contacts/turning_forces.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

using Does = FrictionChoice::Does;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Sweeps of forces end after so many, or where they change by less than this part of the greatest.
constexpr int most_sweeps = 2000;
constexpr double settled = 1e-10;
/// The same where forces are looked for at all touches at once.
constexpr double exact = 1e-12;
/// Of the sweeps of a step half as many, so often: what takes more is left.
constexpr int fewer = 3;
/// Forces that are nearer to their bound than this part of it are at it.
constexpr double at_bound = 1e-9;
/// What slides, so many times as fast as the largest load changes it, goes on where it goes.
constexpr double goes_on = 1e6;
/// What parts by more than this part of the largest load does: less is roundoff of the solve.
constexpr double opens = 1e-10;

}  // namespace

/// One contact of a sweep takes the force that the accelerations by the others ask for.
void TurningForces::sweep(std::size_t k, const FrictionChoice& as_is, std::array<double, 3>& force,
                          std::vector<Twist>& v) const {
  const double mu = state_.touches[k].friction;
  const double before = force[0];
  if (weight_[k] == 0.0) {
    return;  // joints block it
  }
  force[0] = std::max(0.0, before - gap_acceleration(k, v) / weight_[k]);
  push(lines_[k][0], force[0] - before, v);
  if (mu == 0.0) {
    return;
  }
  std::array<double, 2> wanted{};
  if (rubs(as_is)) {
    for (const std::size_t axis : {1U, 2U}) {
      wanted[axis - 1] = -mu * force[0] * as_is.direction.dot(lines_[k][axis].direction);
    }
  } else {
    const Vector3 slides = acceleration(k, v);
    for (const std::size_t axis : {1U, 2U}) {
      const Line& t = lines_[k][axis];
      const double felt = coupling(t, t);
      // Where joints block it nothing moves, whatever pushes.
      wanted[axis - 1] = felt > 0.0 ? force[axis] - slides.dot(t.direction) / felt : 0.0;
    }
    const double size = hypotenuse(wanted[0], wanted[1]);
    const double most = force[0] > 0.0 ? mu * force[0] : 0.0;
    if (size > most) {
      wanted[0] *= most / size;
      wanted[1] *= most / size;
    }
  }
  for (const std::size_t axis : {1U, 2U}) {
    push(lines_[k][axis], wanted[axis - 1] - force[axis], v);
    force[axis] = wanted[axis - 1];
  }
}

std::vector<FrictionChoice> TurningForces::propose(std::span<const FrictionChoice> as_is) {
  std::vector<std::array<double, 3>> force(as_is.size(), {0.0, 0.0, 0.0});
  std::vector<Twist> v = state_.loads;
  for (int round = 0; round < most_sweeps; ++round) {
    double changed = 0.0;
    double most = 0.0;
    for (std::size_t k = 0; k < as_is.size(); ++k) {
      const std::array<double, 3> before = force[k];
      sweep(k, as_is[k], force[k], v);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        changed = std::max(changed, std::abs(force[k][axis] - before[axis]));
        most = std::max(most, std::abs(force[k][axis]));
      }
    }
    if (changed <= settled * most) {
      break;
    }
  }
  double most = 0.0;
  for (const auto& f : force) {
    most = std::max(most, f[0]);
  }
  std::vector<FrictionChoice> choices(as_is.begin(), as_is.end());
  for (std::size_t k = 0; k < as_is.size(); ++k) {
    const double mu = state_.touches[k].friction;
    const double along = hypotenuse(force[k][1], force[k][2]);
    if (force[k][0] <= 1e-7 * most) {
      choices[k].does = Does::opens;
    } else if (choices[k].does == Does::sticks && std::isfinite(mu) &&
               along >= mu * force[k][0] * (1.0 - 1e-6)) {
      choices[k].does = Does::begins;
      const Vector3 f = force[k][1] * lines_[k][1].direction + force[k][2] * lines_[k][2].direction;
      choices[k].direction = along > 0.0 ? Vector3(-f / along) : Vector3(Vector3::Zero());
    }
  }
  return choices;
}

std::vector<FrictionChoice> TurningForces::propose_at_once(std::span<const FrictionChoice> as_is,
                                                           int halvings) {
  const std::size_t n = as_is.size();
  std::vector<SweptTouch> touches;
  for (std::size_t k = 0; k < n; ++k) {
    const Touch& touch = state_.touches[k];
    touches.push_back({touch.a, touch.b, now_[k].normal, now_[k].point_a, now_[k].point_b,
                       touch.rough ? std::numeric_limits<double>::infinity() : touch.friction});
  }
  const ContactSweeps sweeps(state_.bodies, touches, state_.joints);
  std::vector<Vector3> rates;
  for (std::size_t k = 0; k < n; ++k) {
    Vector3 rate = now_[k].bias;
    if (as_is[k].does == Does::slides) {
      rate += goes_on * load_ * as_is[k].direction;
    }
    rates.emplace_back(sweeps.axes(k) * rate);
    rates.back().x() = now_[k].normal_bias;
  }
  std::vector<ContactSweeps::Vector6> accelerations;
  for (const Twist& load : state_.loads) {
    accelerations.emplace_back() << load.linear, load.angular;
  }
  const auto found = sweeps.sweep(std::move(accelerations), rates, {}, exact * load_, true,
                                  SweptFor::instant, fewer + halvings);
  ++solves_;
  if (!(found.changed <= settled * load_)) {
    return {};
  }
  std::vector<FrictionChoice> choices(as_is.begin(), as_is.end());
  double most = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    most = std::max(most, now_[k].normal.dot(found.impulse[k]));
  }
  for (std::size_t k = 0; k < n; ++k) {
    const double mu = touches[k].friction;
    const double pressed = now_[k].normal.dot(found.impulse[k]);
    const Vector3 along = found.impulse[k] - pressed * now_[k].normal;
    if (pressed <= exact * most) {
      const Vector3 goes = sweeps.rate(k, found.velocities) + rates[k];
      const bool stays =
          goes.x() <= turning_roundoff * load_ &&
          (as_is[k].does != Does::sticks || goes.tail<2>().norm() <= turning_roundoff * load_);
      choices[k].does = stays ? choices[k].does : Does::opens;
    } else if (choices[k].does == Does::sticks && std::isfinite(mu) &&
               along.norm() >= mu * pressed * (1.0 - at_bound)) {
      choices[k] = {Does::begins, along.isZero(0.0) ? along : Vector3(-along.normalized())};
    }
  }
  return choices;
}

double TurningForces::contradiction(std::span<const FrictionChoice> choices) {
  const double residual = solve(choices, Which::nearly_least).residual;
  return residual < turning_contradiction ? residual : 0.0;
}

std::vector<FrictionChoice> TurningForces::fewest(std::span<const FrictionChoice> choices) {
  std::vector<Line> asks;
  std::vector<Line> along;
  std::vector<Line> presses;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    if (!pushes(choices[k])) {
      continue;
    }
    asks.push_back(lines_[k][0]);
    presses.push_back(pressing_line(k, choices[k]));
    if (choices[k].does == Does::sticks) {
      for (const std::size_t axis : {1U, 2U}) {
        asks.push_back(lines_[k][axis]);
        along.push_back(lines_[k][axis]);
      }
    }
  }
  const auto free = static_cast<Index>(along.size());
  along.insert(along.end(), presses.begin(), presses.end());
  const NonnegativeSolution answer =
      solve_nonnegative(couplings(asks, along), -loads_along(asks), free);
  solves_ += answer.solves;
  std::vector<FrictionChoice> out(choices.begin(), choices.end());
  for (std::size_t r = 0; r < presses.size(); ++r) {
    if (!(answer.x[free + static_cast<Index>(r)] > 0.0)) {
      out[presses[r].touch].does = Does::opens;
    }
  }
  return out;
}

std::vector<FrictionChoice> TurningForces::complementary(std::span<const FrictionChoice> as_is) {
  const std::size_t n = as_is.size();
  std::vector<char> presses(n, 1);
  for (std::size_t round = 0; round <= n; ++round) {
    // Normals first, then the tangents of what is pressed and sticks.
    std::vector<Line> lines;
    for (std::size_t k = 0; k < n; ++k) {
      lines.push_back(lines_[k][0]);
    }
    for (std::size_t k = 0; k < n; ++k) {
      for (const std::size_t axis : {1U, 2U}) {
        if (presses[k] != 0 && as_is[k].does == Does::sticks) {
          lines.push_back(lines_[k][axis]);
        }
      }
    }
    const auto rows = static_cast<Index>(n);
    const auto all = static_cast<Index>(lines.size());
    MatrixXd K = couplings(lines, lines);
    VectorXd q = loads_along(lines);
    for (std::size_t k = 0; k < n; ++k) {
      if (weight_[k] == 0.0) {
        q[static_cast<Index>(k)] = 0.0;  // joints block it: what is left is roundoff
      }
    }
    ++solves_;
    const Index tangents = all - rows;
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> held;
    if (tangents > 0) {
      held.setThreshold(implied);
      held.compute(K.bottomRightCorner(tangents, tangents));
      const MatrixXd of_normals = held.solve(K.bottomLeftCorner(tangents, rows));
      const VectorXd of_loads = held.solve(q.tail(tangents));
      q.head(rows) -= K.topRightCorner(rows, tangents) * of_loads;
      K.topLeftCorner(rows, rows) -= K.topRightCorner(rows, tangents) * of_normals;
    }
    const MatrixXd W =
        0.5 * (K.topLeftCorner(rows, rows) + K.topLeftCorner(rows, rows).transpose());
    const Complementarity found = solve_complementarity(W, q.head(rows));
    if (!found.solved) {
      return {};
    }
    const VectorXd parts = W * found.x + q.head(rows);
    std::vector<FrictionChoice> choices(as_is.begin(), as_is.end());
    bool changed = false;
    for (std::size_t k = 0; k < n; ++k) {
      if (parts[static_cast<Index>(k)] > opens * load_) {
        choices[k].does = Does::opens;
        changed = changed || presses[k] != 0;
        presses[k] = 0;
      }
    }
    if (!changed || tangents == 0) {
      return choices;
    }
  }
  return {};
}

}  // namespace core
}  // namespace kairos
