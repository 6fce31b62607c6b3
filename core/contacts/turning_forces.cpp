#include "core/contacts/turning_forces.hpp"

#include "core/circular.hpp"
#include "core/contacts/least_norm.hpp"
#include "core/contacts/nonnegative_solve.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SparseLU>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

using Does = FrictionChoice::Does;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The same of rows that contradict the others by roundoff, and by no more than is accepted.
constexpr double nearly_implied = 1e-8;
/// Rays that stand for a cone, one of them along the force that is asked for.
constexpr int rays_of_cone = 16;
/// Forces that are off by this part of the largest load are what was asked for, as they are where
/// a mode is found: what ends one is several times as much.
constexpr double carried = 1e-11;

/// Systems of so many rows are worth the order of a sparse decomposition.
constexpr Index many = 32;

/// Solves K x = -q by a decomposition of a damped K for what is left, again and again; false: it
/// does not get there, and what is left is not as much as equations leave that contradict each
/// other.
template <typename Decomposition>
bool refine(const Decomposition& decomposition, const MatrixXd& K, const VectorXd& q, double load,
            VectorXd& x) {
  constexpr int most_rounds = 6;
  constexpr double solved = 1e-14;  // of the load
  x = VectorXd::Zero(q.size());
  VectorXd rest = -q;
  double off = rest.lpNorm<Eigen::Infinity>();
  for (int round = 0; round < most_rounds && off > solved * load; ++round) {
    x += decomposition.solve(rest);
    rest = -(K * x + q);
    const double before = std::exchange(off, rest.lpNorm<Eigen::Infinity>());
    if (!(off < 0.5 * before)) {
      break;
    }
  }
  return off <= solved * load || (off > turning_contradiction * load && std::isfinite(off));
}

/// Solves K x = -q, where K may be singular: a damped K is not. It is several times as fast as an
/// orthogonal decomposition. Where forces are redundant it finds some that fit. False: see
/// `refine`.
bool solve_damped(const MatrixXd& K, const VectorXd& q, double load, VectorXd& x) {
  constexpr double damping = 1e-8;  // of the largest element
  MatrixXd damped = K;
  damped.diagonal().array() += damping * K.cwiseAbs().maxCoeff();
  // Dense decompositions by blocks add in an order that depends on the processor's caches; these
  // do not.
  if (K.rows() < many) {
    return refine(Eigen::FullPivLU<MatrixXd>(damped), K, q, load, x);
  }
  // Touches that share no body have nothing to do with each other.
  const Eigen::SparseMatrix<double> few = damped.sparseView();
  const Eigen::SparseLU<Eigen::SparseMatrix<double>> decomposition(few);
  return decomposition.info() == Eigen::Success && refine(decomposition, K, q, load, x);
}

}  // namespace

TurningForces::TurningForces(const TurningState& state) : state_(state), load_(state.applied) {
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    free_ += moves(state.bodies[i]) ? 1 : 0;
    load_ = std::max(
        load_, state.loads[i].linear.norm() + state.loads[i].angular.norm() * state.radius[i]);
  }
  for (std::size_t k = 0; k < state.touches.size(); ++k) {
    const Touch& touch = state.touches[k];
    now_.push_back(look_at(touch, state.states[touch.a], state.states[touch.b]));
    load_ = std::max({load_, std::abs(now_.back().normal_bias), now_.back().bias.norm()});
    const Vector3& n = now_.back().normal;
    Vector3 t1 = now_.back().velocity - n * n.dot(now_.back().velocity);
    t1 = t1.norm() > 0.0 ? Vector3(t1.normalized()) : n.unitOrthogonal();
    t1 = (t1 - n * n.dot(t1)).normalized();
    Vector3 t2 = n.cross(t1);
    if (state.joints != nullptr && touch.friction > 0.0) {
      const ContactSystem bodies{state.bodies, {}, state.joints};
      std::tie(t1, t2) = contact_tangents(bodies, touch.a, touch.b, now_.back().point_b, n, t1);
    }
    lines_.push_back({line(k, n), line(k, t1), line(k, t2)});
    weight_.push_back(coupling(lines_.back()[0], lines_.back()[0]));
  }
}

TurningForces::Line TurningForces::line(std::size_t k, const Vector3& d) const {
  const Touch& touch = state_.touches[k];
  Line out{k, d, {}, {}, {}, {}, {}};
  const auto side = [&](std::size_t i, const Vector3& point, double sign, Vector6& asks,
                        Vector6& gives) {
    const GroupBody& body = state_.bodies[i];
    const Vector3 moment = (point - body.position).cross(d);
    asks.head<3>() = sign * d;
    asks.tail<3>() = sign * moment;
    gives.head<3>() = sign * body.inverse_mass * d;
    gives.tail<3>() = sign * (body.inverse_inertia * moment);
  };
  side(touch.a, now_[k].point_a, -1.0, out.of_a, out.to_a);
  side(touch.b, now_[k].point_b, 1.0, out.of_b, out.to_b);
  if (state_.joints != nullptr) {
    const auto at = [](std::size_t i) { return static_cast<Index>(6 * i); };
    VectorXd asks = VectorXd::Zero(at(state_.bodies.size()));
    out.to_all = asks;
    asks.segment<6>(at(touch.a)) = out.of_a;
    asks.segment<6>(at(touch.b)) = out.of_b;
    out.to_all.segment<6>(at(touch.a)) = out.to_a;
    out.to_all.segment<6>(at(touch.b)) = out.to_b;
    state_.joints->pass_on(asks, out.to_all);
  }
  return out;
}

TurningForces::Line TurningForces::pressing_line(std::size_t k,
                                                 const FrictionChoice& choice) const {
  const double mu = state_.touches[k].friction;
  if (!rubs(choice) || !(mu > 0.0) || choice.direction.isZero(0.0)) {
    return lines_[k][0];
  }
  // What stands for infinite friction is solved for as a force, and not as the normal force that it
  // takes: the equations would be as far apart as the two are.
  const double unit = state_.touches[k].rough ? 1.0 / hypotenuse(1.0, mu) : 1.0;
  return line(k, unit * (now_[k].normal - mu * choice.direction));
}

MatrixXd TurningForces::couplings(std::span<const Line> asks, std::span<const Line> gives) const {
  MatrixXd K = MatrixXd::Zero(static_cast<Index>(asks.size()), static_cast<Index>(gives.size()));
  const auto coupled = [&](const Line& ask, const Line& give) {
    const Touch& r = state_.touches[ask.touch];
    const Touch& s = state_.touches[give.touch];
    const auto moved_by = [&](std::size_t i) {
      return (i == s.a || i == s.b) && moves(state_.bodies[i]);
    };
    return state_.joints != nullptr || moved_by(r.a) || moved_by(r.b);
  };
  // Lines of a touch follow each other.
  const auto end_of = [](std::span<const Line> lines, std::size_t from) {
    std::size_t to = from + 1;
    while (to < lines.size() && lines[to].touch == lines[from].touch) {
      ++to;
    }
    return to;
  };
  for (std::size_t r = 0; r < asks.size(); r = end_of(asks, r)) {
    const std::size_t rows_end = end_of(asks, r);
    for (std::size_t c = 0; c < gives.size();) {
      const std::size_t columns_end = end_of(gives, c);
      const bool some = coupled(asks[r], gives[c]);
      for (; c < columns_end; ++c) {
        for (std::size_t i = r; i < rows_end && some; ++i) {
          K(static_cast<Index>(i), static_cast<Index>(c)) = coupling(asks[i], gives[c]);
        }
      }
    }
  }
  return K;
}

VectorXd TurningForces::loads_along(std::span<const Line> lines) const {
  VectorXd q(static_cast<Index>(lines.size()));
  for (Index r = 0; r < q.size(); ++r) {
    const Line& line = lines[static_cast<std::size_t>(r)];
    const bool normal = line.direction == now_[line.touch].normal;
    q[r] = normal ? gap_acceleration(line.touch, state_.loads)
                  : line.direction.dot(acceleration(line.touch, state_.loads));
  }
  return q;
}

double TurningForces::coupling(const Line& asks, const Line& gives) const {
  const Touch& r = state_.touches[asks.touch];
  const Touch& s = state_.touches[gives.touch];
  double sum = 0.0;
  if (state_.joints != nullptr) {
    const auto of = [&](std::size_t i) {
      return gives.to_all.segment<6>(static_cast<Index>(6 * i));
    };
    return asks.of_a.dot(of(r.a)) + asks.of_b.dot(of(r.b));
  }
  if (r.a == s.a) sum += asks.of_a.dot(gives.to_a);
  if (r.a == s.b) sum += asks.of_a.dot(gives.to_b);
  if (r.b == s.a) sum += asks.of_b.dot(gives.to_a);
  if (r.b == s.b) sum += asks.of_b.dot(gives.to_b);
  return sum;
}

void TurningForces::push(const Line& line, double force, std::vector<Twist>& v) const {
  const Touch& touch = state_.touches[line.touch];
  if (state_.joints != nullptr) {
    for (std::size_t i = 0; i < v.size(); ++i) {
      v[i].linear += force * line.to_all.segment<3>(static_cast<Index>(6 * i));
      v[i].angular += force * line.to_all.segment<3>(static_cast<Index>(6 * i + 3));
    }
    return;
  }
  v[touch.a].linear += force * line.to_a.head<3>();
  v[touch.a].angular += force * line.to_a.tail<3>();
  v[touch.b].linear += force * line.to_b.head<3>();
  v[touch.b].angular += force * line.to_b.tail<3>();
}

Vector3 TurningForces::acceleration(std::size_t k, std::span<const Twist> v) const {
  const Touch& touch = state_.touches[k];
  const auto at = [&](std::size_t i, const Vector3& point) {
    return v[i].at(point, state_.bodies[i].position);
  };
  return at(touch.b, now_[k].point_b) - at(touch.a, now_[k].point_a) + now_[k].bias;
}

double TurningForces::gap_acceleration(std::size_t k, std::span<const Twist> v) const {
  return now_[k].normal.dot(acceleration(k, v) - now_[k].bias) + now_[k].normal_bias;
}

TurningForces::Solution TurningForces::solve(std::span<const FrictionChoice> choices, Which which) {
  std::vector<Line> asks;
  std::vector<Line> gives;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    if (!pushes(choices[k])) {
      continue;
    }
    asks.push_back(lines_[k][0]);
    gives.push_back(pressing_line(k, choices[k]));
    if (choices[k].does == Does::sticks) {
      for (const std::size_t axis : {1U, 2U}) {
        asks.push_back(lines_[k][axis]);
        gives.push_back(lines_[k][axis]);
      }
    }
  }
  const auto n = static_cast<Index>(asks.size());
  const MatrixXd K = couplings(asks, gives);
  const VectorXd q = loads_along(asks);
  Solution found;
  found.force.assign(choices.size(), Vector3::Zero());
  found.accelerations = state_.loads;
  found.nearly = which == Which::nearly_least;
  if (n == 0) {
    return found;
  }
  ++solves_;
  VectorXd x;
  const bool damped = which == Which::some || (which == Which::some_of_many && n >= many);
  if (!damped || !solve_damped(K, q, load_, x)) {
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
    decomposition.setThreshold(which == Which::nearly_least ? nearly_implied : implied);
    decomposition.compute(K);
    x = decomposition.solve(-q);
    x -= decomposition.solve(K * x + q);
  }
  found.residual = (K * x + q).lpNorm<Eigen::Infinity>() / load_;
  for (Index c = 0; c < n; ++c) {
    const Line& column = gives[static_cast<std::size_t>(c)];
    found.force[column.touch] += x[c] * column.direction;
    push(column, x[c], found.accelerations);
  }
  return found;
}

/// The most by which the forces that were found violate a sign or a cone.
double TurningForces::cone_violation(std::span<const FrictionChoice> choices,
                                     const Solution& found) const {
  double worst = 0.0;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    if (!pushes(choices[k])) {
      continue;
    }
    const Vector3& n = now_[k].normal;
    const double mu = state_.touches[k].friction;
    const double normal = n.dot(found.force[k]);
    double beyond = -normal;
    if (choices[k].does == Does::sticks && std::isfinite(mu)) {
      const double along = (found.force[k] - normal * n).norm();
      // Infinite friction times the roundoff of the normal force is no roundoff.
      beyond =
          std::max(beyond, state_.touches[k].rough ? along / mu - normal : along - mu * normal);
    }
    worst = std::max(worst, beyond * weight_[k] / load_);
  }
  return worst;
}

TurningForces::Rays TurningForces::rays_of(std::span<const FrictionChoice> choices,
                                           const Solution& found) const {
  Rays out;
  std::vector<Line>& rays = out.lines;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    if (!pushes(choices[k])) {
      continue;
    }
    const Vector3& n = now_[k].normal;
    const double mu = state_.touches[k].friction;
    if (choices[k].does != Does::sticks || mu == 0.0) {
      const bool leans = mu > 0.0 && !choices[k].direction.isZero(0.0);
      rays.push_back(line(k, leans ? Vector3(n - mu * choices[k].direction) : n));
      continue;
    }
    const Vector3 asked = found.force[k] - n * n.dot(found.force[k]);
    const Vector3 t1 = asked.norm() > 0.0 ? Vector3(asked.normalized()) : n.unitOrthogonal();
    const Vector3 t2 = n.cross(t1);
    if (std::isinf(mu)) {
      rays.push_back(line(k, n));
    }
    for (int j = 0; j < rays_of_cone; ++j) {
      const double angle = 2.0 * M_PI * j / rays_of_cone;
      const Vector3 along = cosine(angle) * t1 + sine(angle) * t2;
      rays.push_back(line(k, std::isinf(mu) ? along : Vector3(n + mu * along)));
    }
  }
  const auto rows = static_cast<Index>(6 * state_.bodies.size());
  MatrixXd& A = out.gives;
  VectorXd& b = out.asked;
  A = MatrixXd::Zero(rows, static_cast<Index>(rays.size()));
  b.resize(rows);
  for (std::size_t i = 0; i < state_.bodies.size(); ++i) {
    const auto at = static_cast<Index>(6 * i);
    const Twist& with = found.accelerations[i];
    b.segment<3>(at) = with.linear - state_.loads[i].linear;
    b.segment<3>(at + 3) = state_.radius[i] * (with.angular - state_.loads[i].angular);
  }
  for (std::size_t c = 0; c < rays.size(); ++c) {
    const Touch& touch = state_.touches[rays[c].touch];
    const auto column = static_cast<Index>(c);
    const auto place = [&](std::size_t i, const Vector6& gives) {
      const auto at = static_cast<Index>(6 * i);
      A.block<3, 1>(at, column) += gives.head<3>();
      A.block<3, 1>(at + 3, column) += state_.radius[i] * gives.tail<3>();
    };
    if (state_.joints != nullptr) {
      for (std::size_t i = 0; i < state_.bodies.size(); ++i) {
        place(i, rays[c].to_all.segment<6>(static_cast<Index>(6 * i)));
      }
    } else {
      place(touch.a, rays[c].to_a);
      place(touch.b, rays[c].to_b);
    }
    out.length.push_back(std::max(A.col(column).norm(), 1e-300));
    A.col(column) /= out.length.back();
  }
  return out;
}

void TurningForces::put_forces(const Rays& rays, const VectorXd& x, Solution& found) {
  std::fill(found.force.begin(), found.force.end(), Vector3::Zero());
  for (std::size_t c = 0; c < rays.lines.size(); ++c) {
    found.force[rays.lines[c].touch] +=
        x[static_cast<Index>(c)] / rays.length[c] * rays.lines[c].direction;
  }
}

/// Finds forces inside the cones that do the same; tells how far the nearest are from doing so.
double TurningForces::nearest_in_cones(std::span<const FrictionChoice> choices, Solution& found,
                                       std::vector<std::size_t>* carry) {
  const Rays rays = rays_of(choices, found);
  const NonnegativeSolution answer = solve_nonnegative(rays.gives, rays.asked, 0);
  solves_ += answer.solves;
  put_forces(rays, answer.x, found);
  if (carry != nullptr) {
    carry->clear();
    for (std::size_t c = 0; c < rays.lines.size(); ++c) {
      if (answer.x[static_cast<Index>(c)] > 0.0) {
        carry->push_back(c);
      }
    }
  }
  return answer.residual / load_;
}

/// Whether the rays that carried the load before do so still, pressing all of them. One solution
/// then stands for the search, which takes one for each ray.
bool TurningForces::carried_as_before(std::span<const FrictionChoice> choices, Solution& found,
                                      const std::vector<std::size_t>& carry) {
  const Rays rays = rays_of(choices, found);
  if (carry.empty() || carry.back() >= rays.lines.size()) {
    return false;
  }
  MatrixXd part(rays.gives.rows(), static_cast<Index>(carry.size()));
  for (std::size_t k = 0; k < carry.size(); ++k) {
    part.col(static_cast<Index>(k)) = rays.gives.col(static_cast<Index>(carry[k]));
  }
  ++solves_;
  // Of what hardly carries anything roundoff may be below zero.
  const VectorXd of_part = least_norm(part, rays.asked).cwiseMax(0.0);
  const double off = (rays.asked - part * of_part).lpNorm<Eigen::Infinity>() / load_;
  if (!(off <= carried)) {
    return false;
  }
  VectorXd x = VectorXd::Zero(rays.gives.cols());
  for (std::size_t k = 0; k < carry.size(); ++k) {
    x[static_cast<Index>(carry[k])] = of_part[static_cast<Index>(k)];
  }
  put_forces(rays, x, found);
  found.violation = off;
  return true;
}

/// The most by which what opens would close.
double TurningForces::closing(std::span<const FrictionChoice> choices,
                              const Solution& found) const {
  double worst = 0.0;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    if (!pushes(choices[k])) {
      worst = std::max(worst, -gap_acceleration(k, found.accelerations) / load_);
    }
  }
  return worst;
}

TurningForces::Solution TurningForces::verified(std::span<const FrictionChoice> choices,
                                                const Verifying& options) {
  const auto is_beyond = [](const Solution& s) {
    return s.violation > FrictionForces::solve_roundoff;
  };
  const bool nearly = options.nearly;
  Solution found = solve(choices, nearly ? Which::nearly_least : of_several(Which::some_of_many));
  found.violation = cone_violation(choices, found);
  if (const double closes = closing(choices, found);
      closes > std::max(options.most, found.allowed())) {
    found.violation = std::max(found.violation, closes);
    return found;
  }
  std::vector<std::size_t>* const carry = options.carry;
  if (is_beyond(found) && held_at_edges(choices, found, options.carry)) {
    return found;
  }
  const bool as_before = carry != nullptr && is_beyond(found) &&
                         found.residual < turning_contradiction &&
                         carried_as_before(choices, found, *carry);
  if (!as_before && !nearly && is_beyond(found) && several()) {
    found = solve(choices);
    found.violation = cone_violation(choices, found);
  }
  if (!as_before && !nearly && is_beyond(found)) {
    Solution other = solve(choices, Which::nearly_least);
    other.violation = std::max(cone_violation(choices, other), closing(choices, other));
    if (other.residual < turning_contradiction && other.violation <= other.allowed()) {
      return other;
    }
  }
  if (!as_before && is_beyond(found) && found.residual < turning_contradiction) {
    Solution other = found;
    const double off = nearest_in_cones(choices, other, carry);
    if (off < found.violation) {
      other.violation = off;
      found = std::move(other);
    }
  }
  found.violation = std::max(found.violation, closing(choices, found));
  return found;
}

}  // namespace core
}  // namespace kairos
