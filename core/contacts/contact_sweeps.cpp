#include "core/contacts/contact_sweeps.hpp"

#include "core/contacts/coulomb_cone.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

constexpr int most_sweeps = 4000;
/// After so many sweeps impulses change by half of what they would alone: what goes round in a
/// circle comes to rest. They stay within their cones, which are convex.
constexpr int damped_from = 1000;
/// Redundant touches that contradict each other by roundoff of where they are cannot settle better
/// than by this many times that, which is believed up to this many times what counts as settled.
constexpr double contradiction = 4.0;
constexpr double most_contradiction = 100.0;
/// Sweeps that change less than this many times what has settled, and do not come to half of that
/// in so many more, change what rounding does: others would do the same.
constexpr double nearly_settled = 1e4;
constexpr int idle_sweeps = 64;
/// What has not settled after so many sweeps is looked for at all touches at once, and after so
/// many times as many again and again, in these ways: all of them before `most_sweeps`.
constexpr int at_once_after = 64;
constexpr int later_in_impacts = 3;
constexpr int later_in_steps = 4;
constexpr std::array ways_of_impacts = {AtOnce::newton, AtOnce::interior, AtOnce::proximal,
                                        AtOnce::bounded};
constexpr std::array ways_of_instants = {AtOnce::newton, AtOnce::interior, AtOnce::newton};
constexpr std::array ways_of_steps = {AtOnce::compliant, AtOnce::interior, AtOnce::newton};
constexpr std::array last_ways_of_steps = {AtOnce::compliant, AtOnce::interior, AtOnce::held_along};

std::span<const AtOnce> ways_of(SweptFor what) {
  switch (what) {
    case SweptFor::impact:
      return ways_of_impacts;
    case SweptFor::instant:
      return ways_of_instants;
    case SweptFor::step:
      return ways_of_steps;
    case SweptFor::last_resort:
      break;
  }
  return last_ways_of_steps;
}

/// When sweeps of a step over many touches are helped by linear systems (`solve_as_found`). What
/// these give is swept on, and taken back if it has not come nearer in the end. What settles is
/// tried once, too: among redundant touches that slide, the order of a sweep would make a choice.
class Trial {
 public:
  /// Whether a system is to be solved after this sweep, which changed so much.
  [[nodiscard]] bool is_due(int round, double changed, double settled) const {
    return runs() ? (round - begin_) % solve_every == 0
                  : trials_ < most_trials &&
                        ((changed <= settled && is_new()) ||
                         (round >= next_ &&
                          (changed <= nearly_settled * settled || round >= whatever_from)));
  }
  [[nodiscard]] bool is_new() const { return trials_ == 0; }
  [[nodiscard]] bool runs() const { return begin_ >= 0; }
  void begin(int round, double changed, const std::vector<Vector3>& along) {
    begin_ = round;
    changed_ = changed;
    along_ = along;
    ++trials_;
  }
  [[nodiscard]] bool ends(int round) const { return runs() && round == begin_ + lasts; }
  /// Whether it is to be taken back: it ended, and changes so much.
  bool in_vain(int round, double changed) {
    begin_ = -1;
    anew_ = !(changed < changed_);
    failed_ += anew_ ? 1 : 0;
    next_ = round + (wait << failed_);
    return anew_;
  }
  /// Whether impulses are solved for without regard to what they were.
  bool anew() { return std::exchange(anew_, false); }
  /// What to go back to, and what the sweep before it changed.
  [[nodiscard]] const std::vector<Vector3>& along() const { return along_; }
  [[nodiscard]] double changed() const { return changed_; }

 private:
  static constexpr int solve_every = 12;
  static constexpr int lasts = 48;
  static constexpr int most_trials = 8;
  static constexpr int first = 16;
  static constexpr int wait = 16;             ///< after one in vain twice as long each time
  static constexpr int whatever_from = 1000;  ///< however far from settled
  std::vector<Vector3> along_;
  double changed_ = 0.0;
  bool anew_ = true;
  int begin_ = -1;
  int next_ = first;
  int trials_ = 0;
  int failed_ = 0;
};

}  // namespace

ContactSweeps::ContactSweeps(std::span<const GroupBody> bodies, std::span<const SweptTouch> touches,
                             std::shared_ptr<const GroupJoints> joints)
    : joints_(std::move(joints)) {
  std::vector<Matrix3> turns;  // roots of inverse inertias
  for (const GroupBody& body : bodies) {
    turns.push_back(body.inverse_inertia.isZero(0.0)
                        ? Matrix3(Matrix3::Zero())
                        : Matrix3(body.inverse_inertia.llt().matrixL()));
  }
  for (const SweptTouch& touch : touches) {
    Block out;
    out.a = touch.a;
    out.b = touch.b;
    out.friction = touch.friction;
    const Vector3& n = touch.normal;
    Vector3 t = n.unitOrthogonal();
    if (joints_ != nullptr) {
      const ContactSystem system{{bodies.begin(), bodies.end()}, {}, joints_};
      t = contact_tangents(system, touch.a, touch.b, touch.point_b, n, t).first;
    }
    out.axes << n.transpose(), t.transpose(), n.cross(t).transpose();
    const auto side = [&](std::size_t i, const Vector3& point, double sign, Matrix36& of,
                          Matrix63& to, Matrix36& root) {
      for (int r = 0; r < 3; ++r) {
        const Vector3 d = sign * out.axes.row(r);
        const Vector3 moment = (point - bodies[i].position).cross(d);
        of.row(r) << d.transpose(), moment.transpose();
        to.col(r) << bodies[i].inverse_mass * d, bodies[i].inverse_inertia * moment;
      }
      root << std::sqrt(bodies[i].inverse_mass) * of.leftCols<3>(), of.rightCols<3>() * turns[i];
    };
    side(touch.a, touch.point_a, -1.0, out.of_a, out.to_a, out.root_a);
    side(touch.b, touch.point_b, 1.0, out.of_b, out.to_b, out.root_b);
    out.W = out.of_a * out.to_a + out.of_b * out.to_b;
    if (joints_ != nullptr) {
      pass_on(bodies, touch, out);
    }
    blocks_.push_back(out);
  }
}

/// What joints make of a touch.
void ContactSweeps::pass_on(std::span<const GroupBody> bodies, const SweptTouch& touch,
                            Block& block) const {
  block.to_all.setZero(static_cast<Eigen::Index>(6 * bodies.size()), 3);
  for (int r = 0; r < 3; ++r) {
    Eigen::VectorXd asks = Eigen::VectorXd::Zero(block.to_all.rows());
    Eigen::VectorXd gives = asks;
    for (const auto& [place, of, to] :
         {std::tuple{touch.a, &block.of_a, &block.to_a}, {touch.b, &block.of_b, &block.to_b}}) {
      const auto at = static_cast<Eigen::Index>(6 * place);
      asks.segment<6>(at) = of->row(r).transpose();
      gives.segment<6>(at) = to->col(r);
    }
    joints_->pass_on(asks, gives);
    block.to_all.col(r) = gives;
    block.blocked[static_cast<std::size_t>(r)] = gives.isZero(0.0);
  }
  const Matrix3 W = between(block, block);
  block.W = 0.5 * (W + W.transpose());
}

/// What a unit of impulses at one touch does to the rates of another among joints. What these block
/// neither gives nor is given anything.
Matrix3 ContactSweeps::between(const Block& asks, const Block& gives) {
  Matrix3 W = asks.of_a * gives.to_all.middleRows<6>(static_cast<Eigen::Index>(6 * asks.a)) +
              asks.of_b * gives.to_all.middleRows<6>(static_cast<Eigen::Index>(6 * asks.b));
  for (int r = 0; r < 3; ++r) {
    if (asks.blocked[static_cast<std::size_t>(r)]) {
      W.row(r).setZero();
    }
  }
  return W;
}

/// Each touch in turn is given this share of what it lacks; returns the most that changed, m/s.
double ContactSweeps::sweep_once(std::span<const Vector3> rates, bool rubs, double share,
                                 std::vector<Vector3>& along,
                                 std::vector<Vector6>& velocities) const {
  double changed = 0.0;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const Block& block = blocks_[k];
    if (!block.presses()) {
      continue;
    }
    const Vector3 u = rate_of(k, velocities, rates);
    const Vector3 alone =
        coulomb_impulse(block.W, u - block.W * along[k], rubs ? block.friction : 0.0);
    const Vector3 more = share * (alone - along[k]);
    if (more.isZero(0.0)) {
      continue;
    }
    push_along(block, more, velocities);
    changed = std::max(changed, (block.W * more).norm());
    along[k] += more;
  }
  return changed;
}

ContactSweeps::Swept ContactSweeps::sweep(std::vector<Vector6> velocities,
                                          std::span<const Vector3> rates,
                                          std::span<const Vector3> begin, double settled, bool rubs,
                                          SweptFor what, int halvings) const {
  Swept swept{std::vector<Vector3>(blocks_.size(), Vector3::Zero()), velocities};
  std::vector<Vector3> along(blocks_.size(), Vector3::Zero());
  for (std::size_t k = 0; k < blocks_.size() && !begin.empty(); ++k) {
    along[k] = blocks_[k].presses() ? Vector3(blocks_[k].axes * begin[k]) : Vector3::Zero();
  }
  push_all(along, swept.velocities);
  double least = nearly_settled * settled;
  int idle = 0;
  const bool in_step = what != SweptFor::impact;
  const bool many = in_step && blocks_.size() > most_for_newton;
  int at_once = blocks_.size() <= most_at_once ? at_once_after : most_sweeps;
  std::span<const AtOnce> ways = ways_of(what);
  if (blocks_.size() > most_for_newton && ways.front() == AtOnce::newton) {
    ways = ways.subspan(1);
  }
  Trial trial;
  double near_enough = settled;
  for (int round = 0; round < most_sweeps >> halvings; ++round) {
    swept.changed =
        sweep_once(rates, rubs, round < damped_from ? 1.0 : 0.5, along, swept.velocities);
    swept.solves += static_cast<int>(blocks_.size());
    if (trial.ends(round) && trial.in_vain(round, swept.changed)) {
      near_enough = settled;
      swept.changed = trial.changed();
      along = trial.along();
      swept.velocities = velocities;
      push_all(along, swept.velocities);
    }
    if (swept.changed <= near_enough && !(many && trial.is_new())) {
      break;
    }
    if (many && trial.is_due(round, swept.changed, settled)) {
      if (!trial.runs()) {
        trial.begin(round, swept.changed, along);
      }
      const double off =
          solve_as_found(velocities, rates, rubs, trial.anew(), along, swept.velocities);
      near_enough = contradiction * off <= most_contradiction * settled
                        ? std::max(settled, contradiction * off)
                        : settled;
      continue;
    }
    if (swept.changed <= 0.5 * least) {
      least = swept.changed;
      idle = 0;
    } else if (swept.changed <= nearly_settled * settled && ++idle >= idle_sweeps) {
      break;
    }
    if (round == at_once && !ways.empty()) {
      at_once *= in_step ? later_in_steps : later_in_impacts;
      const AtOnce way = ways.front();
      ways = ways.subspan(1);
      // What is left of redundant touches in a step is how they contradict each other; and sweeps
      // would let go again what was held.
      const bool redundant = in_step && way == AtOnce::interior;
      const double enough = (redundant ? most_contradiction : 1.0) * settled;
      const double off =
          settle_at_once(velocities, rates, enough, rubs, way, along, swept.velocities);
      const bool nearly = redundant || way == AtOnce::compliant || way == AtOnce::held_along;
      if (off <= (nearly ? nearly_settled : 1.0) * settled) {
        swept.changed = off;
        break;
      }
    }
  }
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    swept.impulse[k] = blocks_[k].axes.transpose() * along[k];
  }
  return swept;
}

Vector3 ContactSweeps::rate(std::size_t touch, const std::vector<Vector6>& v) const {
  const Block& block = blocks_[touch];
  return block.of_a * v[block.a] + block.of_b * v[block.b];
}

Vector3 ContactSweeps::rate_of(std::size_t touch, const std::vector<Vector6>& v,
                               std::span<const Vector3> rates) const {
  return rate(touch, v) + (rates.empty() ? Vector3::Zero() : rates[touch]);
}

void ContactSweeps::push_all(std::span<const Vector3> along, std::vector<Vector6>& v) const {
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    push_along(blocks_[k], along[k], v);
  }
}

void ContactSweeps::push(std::size_t touch, const Vector3& impulse,
                         std::vector<Vector6>& velocities) const {
  push_along(blocks_[touch], blocks_[touch].axes * impulse, velocities);
}

double ContactSweeps::driven_work(std::span<const Vector3> impulses) const {
  double work = 0.0;
  for (std::size_t k = 0; k < blocks_.size() && joints_ != nullptr && joints_->driven(); ++k) {
    const Block& block = blocks_[k];
    const Vector3 along = block.axes * impulses[k];
    if (along.isZero(0.0)) {
      continue;
    }
    Eigen::VectorXd changes = Eigen::VectorXd::Zero(block.to_all.rows());
    changes.segment<6>(static_cast<Eigen::Index>(6 * block.a)) += block.to_a * along;
    changes.segment<6>(static_cast<Eigen::Index>(6 * block.b)) += block.to_b * along;
    work += joints_->driven_work(changes).sum();
  }
  return work;
}

void ContactSweeps::push_along(const Block& block, const Vector3& impulse,
                               std::vector<Vector6>& v) {
  if (block.to_all.size() > 0) {
    for (std::size_t i = 0; i < v.size(); ++i) {
      v[i] += block.to_all.middleRows<6>(static_cast<Eigen::Index>(6 * i)) * impulse;
    }
    return;
  }
  v[block.a] += block.to_a * impulse;
  v[block.b] += block.to_b * impulse;
}

}  // namespace core
}  // namespace kairos
