#include "core/joint_system.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// A pivot below this, of W scaled to a unit diagonal, counts as zero. Rows that the others imply
/// leave n eps there; chains of bodies whose masses differ by a million leave more than 1e-9.
constexpr double dependent = 1e-11;
constexpr int most_rounds = 50;
/// What the second order resists by less than this part is roundoff: of a loop that moves.
constexpr double resists = 1e-9;

/// A row with what a unit of it does to its two bodies.
struct Row {
  JointRow row;
  double driven_rate = 0.0;
  std::size_t a = JointSystem::nowhere;
  std::size_t b = JointSystem::nowhere;
  Vector3 spin_a = Vector3::Zero();  ///< I_a^-1 turn_a
  Vector3 spin_b = Vector3::Zero();
};

JointEnd end_of(const JointSystem::Side& side, Instant t, std::span<const BodyState> states) {
  if (side.place != JointSystem::nowhere) {
    return {states[side.place].pose, states[side.place].twist, {}};
  }
  if (side.drive == nullptr) {
    return {side.pose, {}, {}};
  }
  const Motion motion = side.drive->motion(t, 1.0);
  return {motion.pose(0.0),
          motion.twist(0.0),
          {motion.velocity.derivative(0.0), motion.angular_velocity.derivative(0.0)}};
}

/// I^-1 x, world frame; 0 where nothing turns it.
Vector3 inverse_inertia(const BodyInertia& inertia, const Quaternion& q, const Vector3& x) {
  if (!inertia.rotates) {
    return Vector3::Zero();
  }
  return inertia.inverse(q, x);
}

}  // namespace

/// Scratch memory of one thread. It grows when a larger system comes, and is allocated at no other
/// time.
struct JointSystem::Workspace {
  std::vector<Row> rows;
  std::vector<JointRow> joint;
  std::vector<Twist> moves;
  Eigen::MatrixXd W;
  Eigen::VectorXd scale;
  Eigen::VectorXd b;
  Eigen::VectorXd x;
  Eigen::LLT<Eigen::MatrixXd> cholesky;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> orthogonal;
  bool regular = true;
  /// Of all changes at once, one by column.
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Columns leaves;
  Columns all;

  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(rows.size()); }
  /// Adds J^T x.
  void react(std::span<Wrench> wrenches) const;
  /// x of W x = b.
  void solve() {
    b.array() *= scale.array();
    if (regular) {
      x = cholesky.solve(b);
    } else {
      x = orthogonal.solve(b);
    }
    x.array() *= scale.array();
  }
  /// The same of each column of `all`, in place; W is regular. Row by row, so that all columns go
  /// on together.
  void solve_all() {
    const auto& L = cholesky.matrixLLT();
    for (Eigen::Index i = 0; i < size(); ++i) {
      all.row(i) *= scale[i];
      for (Eigen::Index k = 0; k < i; ++k) {
        all.row(i) -= L(i, k) * all.row(k);
      }
      all.row(i) /= L(i, i);
    }
    for (Eigen::Index i = size(); i-- > 0;) {
      for (Eigen::Index k = i + 1; k < size(); ++k) {
        all.row(i) -= L(k, i) * all.row(k);
      }
      all.row(i) /= L(i, i);
    }
    for (Eigen::Index i = 0; i < size(); ++i) {
      all.row(i) *= scale[i];
    }
  }
};

JointSystem::Workspace& JointSystem::workspace() {
  thread_local Workspace work;
  return work;
}

JointSystem::JointSystem(std::vector<Placed> joints, std::vector<BodyInertia> inertia)
    : joints_(std::move(joints)), inertia_(std::move(inertia)) {
  for (const Placed& placed : joints_) {
    row_count_ += row_count(placed.joint.kind);
    size_ = std::max(size_, placed.joint.length);
    for (const auto& [joint_side, side] :
         {std::pair(&placed.joint.a, &placed.a), std::pair(&placed.joint.b, &placed.b)}) {
      driven_ = driven_ || side->drive != nullptr;
      if (side->place != nowhere) {
        size_ = std::max({size_, joint_side->point.norm(), inertia_[side->place].bounding_radius});
      }
    }
  }
}

void JointSystem::evaluate(Instant t, std::span<const BodyState> states, Workspace& work) const {
  assert(states.size() == inertia_.size());
  work.rows.resize(row_count_);
  work.joint.resize(most_joint_rows);
  std::size_t first = 0;
  for (const Placed& placed : joints_) {
    const JointEnd a = end_of(placed.a, t, states);
    const JointEnd b = end_of(placed.b, t, states);
    const std::size_t count = row_count(placed.joint.kind);
    joint_rows(placed.joint, a, b, std::span(work.joint).first(count));
    const Twist driven_a = placed.a.drive != nullptr ? a.twist : Twist{};
    const Twist driven_b = placed.b.drive != nullptr ? b.twist : Twist{};
    for (std::size_t k = 0; k < count; ++k) {
      Row& row = work.rows[first + k];
      row.row = work.joint[k];
      row.driven_rate = driven_ ? row.row.rate(driven_a, driven_b) : 0.0;
      row.a = placed.a.place;
      row.b = placed.b.place;
    }
    first += count;
  }
}

void JointSystem::factor(std::span<const BodyState> states, Workspace& work) const {
  for (Row& row : work.rows) {
    const auto spin = [&](std::size_t place, const Vector3& turn) {
      return place == nowhere
                 ? Vector3(Vector3::Zero())
                 : inverse_inertia(inertia_[place], states[place].pose.orientation, turn);
    };
    row.spin_a = spin(row.a, row.row.turn_a);
    row.spin_b = spin(row.b, row.row.turn_b);
  }
  const Eigen::Index n = work.size();
  work.W.resize(n, n);
  work.scale.resize(n);
  const auto felt = [&](std::size_t place, const Row& r, const Row& s, const Vector3& spin,
                        const Vector3& turn) {
    return r.row.direction.dot(s.row.direction) / inertia_[place].mass + spin.dot(turn);
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    const Row& r = work.rows[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k <= i; ++k) {
      const Row& s = work.rows[static_cast<std::size_t>(k)];
      double sum = 0.0;
      if (r.a != nowhere && r.a == s.a) sum += felt(r.a, r, s, r.spin_a, s.row.turn_a);
      if (r.b != nowhere && r.b == s.b) sum += felt(r.b, r, s, r.spin_b, s.row.turn_b);
      if (r.a != nowhere && r.a == s.b) sum -= felt(r.a, r, s, r.spin_a, s.row.turn_b);
      if (r.b != nowhere && r.b == s.a) sum -= felt(r.b, r, s, r.spin_b, s.row.turn_a);
      work.W(i, k) = work.W(k, i) = sum;
    }
    work.scale[i] = work.W(i, i) > 0.0 ? 1.0 / std::sqrt(work.W(i, i)) : 0.0;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index k = 0; k < n; ++k) {
      work.W(i, k) *= work.scale[i] * work.scale[k];
    }
  }
  work.cholesky.compute(work.W);
  work.regular = work.cholesky.info() == Eigen::Success &&
                 work.cholesky.matrixLLT().diagonal().cwiseAbs2().minCoeff() > dependent;
  if (!work.regular) {
    work.orthogonal.setThreshold(dependent);
    work.orthogonal.compute(work.W);
  }
}

std::size_t JointSystem::rank(Instant t, std::span<const BodyState> states) const {
  Workspace& work = workspace();
  evaluate(t, states, work);
  factor(states, work);
  return work.regular ? row_count_ : static_cast<std::size_t>(work.orthogonal.rank());
}

namespace {

/// What a wrench alone makes a body do, m/s^2 and rad/s^2.
Twist acceleration(const BodyInertia& inertia, const BodyState& state, const Wrench& wrench) {
  Twist a;
  a.linear = wrench.force / inertia.mass;
  if (inertia.rotates) {
    a.angular = angular_acceleration(inertia, state, wrench.torque);
  }
  return a;
}

}  // namespace

bool JointSystem::is_stuck(Instant t, std::span<const BodyState> states,
                           std::span<const Wrench> wrenches) const {
  if (driven_ || rank(t, states) == row_count_) {
    return false;
  }
  Workspace& work = workspace();
  // W is symmetric: what its columns leave out it makes nothing of.
  const Eigen::MatrixXd all =
      work.orthogonal.householderQ() * Eigen::MatrixXd::Identity(work.size(), work.size());
  const Eigen::MatrixXd stresses =
      work.scale.asDiagonal() * all.rightCols(work.size() - work.orthogonal.rank());
  const auto largest = [&](std::span<const Twist> twists) {
    double most = 0.0;
    for (std::size_t k = 0; k < twists.size(); ++k) {
      most = std::max(
          {most, twists[k].linear.norm(), twists[k].angular.norm() * inertia_[k].bounding_radius});
    }
    return most;
  };
  std::vector<Twist> motion;
  for (const BodyState& state : states) {
    motion.push_back(state.twist);
  }
  if (largest(motion) == 0.0) {  // that which begins
    for (std::size_t k = 0; k < states.size(); ++k) {
      motion[k] = acceleration(inertia_[k], states[k], wrenches[k]);
    }
    const double pushed = largest(motion);
    (void)pass_on(motion, work);
    if (largest(motion) <= resists * pushed) {
      return false;
    }
  }
  std::vector<BodyState> moving(states.begin(), states.end());
  for (std::size_t k = 0; k < states.size(); ++k) {
    moving[k].twist = motion[k];
  }
  evaluate(t, moving, work);
  const double bend = largest(motion) * largest(motion) / size_;  // about what motion bends rows by
  for (Eigen::Index k = 0; k < stresses.cols(); ++k) {
    double done = 0.0;
    double scale = 0.0;
    for (Eigen::Index i = 0; i < work.size(); ++i) {
      const JointRow& row = work.rows[static_cast<std::size_t>(i)].row;
      done += stresses(i, k) * row.bias;
      scale += std::abs(stresses(i, k)) * bend / (row.turns_only ? size_ : 1.0);
    }
    if (std::abs(done) > resists * scale) {
      return true;
    }
  }
  return false;
}

namespace {

const Twist& twist_of(std::size_t place, std::span<const BodyState> states) {
  static const Twist none;
  return place == JointSystem::nowhere ? none : states[place].twist;
}

double rate_of(const Row& row, std::span<const BodyState> states) {
  return row.row.rate(twist_of(row.a, states), twist_of(row.b, states)) + row.driven_rate;
}

}  // namespace

double JointSystem::residual(Instant t, std::span<const BodyState> states) const {
  Workspace& work = workspace();
  evaluate(t, states, work);
  double largest = 0.0;
  for (const Row& row : work.rows) {
    largest = std::max(largest, std::abs(row.row.residual) * (row.row.turns_only ? size_ : 1.0));
  }
  return largest;
}

double JointSystem::residual_rate(Instant t, std::span<const BodyState> states) const {
  Workspace& work = workspace();
  evaluate(t, states, work);
  double largest = 0.0;
  for (const Row& row : work.rows) {
    largest =
        std::max(largest, std::abs(rate_of(row, states)) * (row.row.turns_only ? size_ : 1.0));
  }
  return largest;
}

void JointSystem::solve_forces(Instant t, std::span<const BodyState> states,
                               std::span<const Wrench> wrenches, Workspace& work) const {
  evaluate(t, states, work);
  factor(states, work);
  const auto pushed = [&](std::size_t place) {
    return place == nowhere ? Twist{}
                            : acceleration(inertia_[place], states[place], wrenches[place]);
  };
  work.b.resize(work.size());
  for (Eigen::Index i = 0; i < work.size(); ++i) {
    const Row& row = work.rows[static_cast<std::size_t>(i)];
    work.b[i] = -(row.row.rate(pushed(row.a), pushed(row.b)) + row.row.bias);
  }
  work.solve();
}

void JointSystem::Workspace::react(std::span<Wrench> wrenches) const {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    const double share = x[static_cast<Eigen::Index>(i)];
    if (row.a != nowhere) {
      wrenches[row.a].force -= share * row.row.direction;
      wrenches[row.a].torque -= share * row.row.turn_a;
    }
    if (row.b != nowhere) {
      wrenches[row.b].force += share * row.row.direction;
      wrenches[row.b].torque += share * row.row.turn_b;
    }
  }
}

void JointSystem::add_forces(Instant t, std::span<const BodyState> states,
                             std::span<Wrench> wrenches) const {
  Workspace& work = workspace();
  solve_forces(t, states, wrenches, work);
  work.react(wrenches);
}

void JointSystem::react(Instant t, std::span<const BodyState> states, std::span<const double> x,
                        std::span<Wrench> wrenches) const {
  Workspace& work = workspace();
  evaluate(t, states, work);
  work.x = Eigen::Map<const Eigen::VectorXd>(x.data(), work.size());
  work.react(wrenches);
}

void JointSystem::multipliers(Instant t, std::span<const BodyState> states,
                              std::span<const Wrench> wrenches, std::span<double> x) const {
  Workspace& work = workspace();
  solve_forces(t, states, wrenches, work);
  Eigen::Map<Eigen::VectorXd>(x.data(), work.size()) = work.x;
}

void JointSystem::residuals(Instant t, std::span<const BodyState> states, std::span<double> r,
                            std::span<double> rates) const {
  Workspace& work = workspace();
  evaluate(t, states, work);
  for (std::size_t i = 0; i < work.rows.size(); ++i) {
    r[i] = work.rows[i].row.residual;
    rates[i] = rate_of(work.rows[i], states);
  }
}

double JointSystem::driven_power(Instant t, std::span<const BodyState> states,
                                 std::span<const Wrench> wrenches) const {
  Workspace& work = workspace();
  solve_forces(t, states, wrenches, work);
  double power = 0.0;
  for (Eigen::Index i = 0; i < work.size(); ++i) {
    power -= work.x[i] * work.rows[static_cast<std::size_t>(i)].driven_rate;
  }
  return power;
}

/// Roundoff of coordinates and arms, m.
double JointSystem::tolerance(std::span<const BodyState> states) const {
  double largest = size_;
  for (const BodyState& state : states) {
    largest = std::max(largest, state.pose.position.lpNorm<Eigen::Infinity>());
  }
  return 2.0 * epsilon * largest;
}

JointProjection JointSystem::project_positions(Instant t, std::span<BodyState> states,
                                               std::span<const Vector3> forces) const {
  Workspace& work = workspace();
  JointProjection result;
  const double enough = tolerance(states);
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_rounds; ++round) {
    const double left = residual(t, states);  // fills the workspace's rows as well
    if (left <= enough || !(left < last)) {
      // Newton's method converges until roundoff. A residual that no longer falls is roundoff, or
      // there is no solution.
      result.converged = left <= 1e-12 * std::max(size_, enough / epsilon);
      return result;
    }
    last = left;
    factor(states, work);
    work.b.resize(work.size());
    for (Eigen::Index i = 0; i < work.size(); ++i) {
      work.b[i] = -work.rows[static_cast<std::size_t>(i)].row.residual;
    }
    work.solve();
    work.moves.assign(states.size(), Twist{});
    const auto move = [&](std::size_t place, const Row& row, const Vector3& spin, double x) {
      if (place != nowhere) {
        work.moves[place].linear += x / inertia_[place].mass * row.row.direction;
        work.moves[place].angular += x * spin;
      }
    };
    for (Eigen::Index i = 0; i < work.size(); ++i) {
      const Row& row = work.rows[static_cast<std::size_t>(i)];
      move(row.a, row, row.spin_a, -work.x[i]);
      move(row.b, row, row.spin_b, work.x[i]);
    }
    for (std::size_t k = 0; k < states.size(); ++k) {
      Pose& pose = states[k].pose;
      pose.position += work.moves[k].linear;
      result.position -= forces[k].dot(work.moves[k].linear);
      if (!work.moves[k].angular.isZero(0.0)) {
        pose.orientation = rotate(work.moves[k].angular, pose.orientation).normalized();
      }
    }
  }
  result.converged = false;
  return result;
}

JointProjection JointSystem::project_velocities(Instant t, std::span<BodyState> states) const {
  Workspace& work = workspace();
  evaluate(t, states, work);
  factor(states, work);
  JointProjection result;
  work.b.resize(work.size());
  for (int round = 0; round < 2; ++round) {  // the second removes the roundoff of the first
    for (Eigen::Index i = 0; i < work.size(); ++i) {
      work.b[i] = -rate_of(work.rows[static_cast<std::size_t>(i)], states);
    }
    work.solve();
    const auto rates = [&](double share) {
      for (Eigen::Index i = 0; i < work.size(); ++i) {
        const Row& row = work.rows[static_cast<std::size_t>(i)];
        result.velocity += share * work.x[i] * rate_of(row, states);
      }
    };
    rates(0.5);
    for (Eigen::Index i = 0; i < work.size(); ++i) {
      const Row& row = work.rows[static_cast<std::size_t>(i)];
      result.driven -= work.x[i] * row.driven_rate;
      if (row.a != nowhere) {
        states[row.a].twist.linear -= work.x[i] / inertia_[row.a].mass * row.row.direction;
        states[row.a].twist.angular -= work.x[i] * row.spin_a;
      }
      if (row.b != nowhere) {
        states[row.b].twist.linear += work.x[i] / inertia_[row.b].mass * row.row.direction;
        states[row.b].twist.angular += work.x[i] * row.spin_b;
      }
    }
    rates(0.5);
  }
  return result;
}

double JointSystem::pass_on(Instant t, std::span<const BodyState> states,
                            std::span<Twist> changes) const {
  Workspace& work = workspace();
  evaluate(t, states, work);
  factor(states, work);
  return pass_on(changes, work);
}

JointSystem::Passing JointSystem::passing(Instant t, std::span<const BodyState> states) const {
  Workspace& work = workspace();
  evaluate(t, states, work);
  factor(states, work);
  const auto n = static_cast<Eigen::Index>(6 * states.size());
  Passing passing{Eigen::MatrixXd(n, n), Eigen::VectorXd(driven_ ? n : 0)};
  if (work.regular) {
    pass_on_all(n, passing.driven, work);
    passing.leaves = work.leaves;
    return passing;
  }
  Eigen::MatrixXd& leaves = passing.leaves;
  std::vector<Twist> changes;
  for (Eigen::Index c = 0; c < n; ++c) {
    changes.assign(states.size(), Twist{});
    Twist& of_one = changes[static_cast<std::size_t>(c / 6)];
    (c % 6 < 3 ? of_one.linear : of_one.angular)[c % 3] = 1.0;
    const double driven = pass_on(changes, work);
    if (driven_) {
      passing.driven[c] = driven;
    }
    for (std::size_t k = 0; k < changes.size(); ++k) {
      leaves.block<3, 1>(static_cast<Eigen::Index>(6 * k), c) = changes[k].linear;
      leaves.block<3, 1>(static_cast<Eigen::Index>(6 * k + 3), c) = changes[k].angular;
    }
  }
  return passing;
}

/// Of a unit of each of n changes, in `work.leaves`, and the work of driven sides; W is regular.
void JointSystem::pass_on_all(Eigen::Index n, Eigen::VectorXd& driven, Workspace& work) const {
  work.leaves.setIdentity(n, n);
  work.all.resize(work.size(), n);
  driven.setZero();
  const auto add = [&work](std::size_t place, Eigen::Index part, const Vector3& d, auto&& with) {
    for (Eigen::Index axis = 0; axis < 3 && place != nowhere; ++axis) {
      with(work.leaves.row(static_cast<Eigen::Index>(6 * place) + part + axis), d[axis]);
    }
  };
  for (int round = 0; round < 2; ++round) {  // the second removes the roundoff of the first
    work.all.setZero();
    for (Eigen::Index i = 0; i < work.size(); ++i) {
      const Row& row = work.rows[static_cast<std::size_t>(i)];
      const auto ask = [&](auto&& leaves, double d) { work.all.row(i) -= d * leaves; };
      add(row.a, 0, -row.row.direction, ask);
      add(row.a, 3, -row.row.turn_a, ask);
      add(row.b, 0, row.row.direction, ask);
      add(row.b, 3, row.row.turn_b, ask);
    }
    work.solve_all();
    for (Eigen::Index i = 0; i < work.size(); ++i) {
      const Row& row = work.rows[static_cast<std::size_t>(i)];
      const auto give = [&](auto&& leaves, double d) { leaves += d * work.all.row(i); };
      const auto linear = [&](std::size_t place, double sign) {
        return place == nowhere ? Vector3(Vector3::Zero())
                                : Vector3(sign / inertia_[place].mass * row.row.direction);
      };
      add(row.a, 0, linear(row.a, -1.0), give);
      add(row.a, 3, -row.spin_a, give);
      add(row.b, 0, linear(row.b, 1.0), give);
      add(row.b, 3, row.spin_b, give);
      if (driven.size() > 0) {
        driven -= row.driven_rate * work.all.row(i).transpose();
      }
    }
  }
}

/// With the workspace's rows, which are factored.
double JointSystem::pass_on(std::span<Twist> changes, Workspace& work) const {
  static const Twist none;
  work.b.resize(work.size());
  double driven = 0.0;
  const auto change = [&](std::size_t place) -> const Twist& {
    return place == nowhere ? none : changes[place];
  };
  for (int round = 0; round < 2; ++round) {
    for (Eigen::Index i = 0; i < work.size(); ++i) {
      const Row& row = work.rows[static_cast<std::size_t>(i)];
      work.b[i] = -row.row.rate(change(row.a), change(row.b));
    }
    work.solve();
    for (Eigen::Index i = 0; i < work.size(); ++i) {
      const Row& row = work.rows[static_cast<std::size_t>(i)];
      driven -= work.x[i] * row.driven_rate;
      if (row.a != nowhere) {
        changes[row.a].linear -= work.x[i] / inertia_[row.a].mass * row.row.direction;
        changes[row.a].angular -= work.x[i] * row.spin_a;
      }
      if (row.b != nowhere) {
        changes[row.b].linear += work.x[i] / inertia_[row.b].mass * row.row.direction;
        changes[row.b].angular += work.x[i] * row.spin_b;
      }
    }
  }
  return driven;
}

}  // namespace core
}  // namespace kairos
