#include "core/contacts/jam.hpp"

#include "core/contacts/cone_newton.hpp"
#include "core/contacts/coulomb_cone.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>

namespace kairos {
inline namespace core {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int most_sweeps = 20'000;
/// What has not settled after so many sweeps, and after four times as many again and again, is
/// looked for at all touches at once, if there are not too many.
constexpr int at_once_after = 64;
/// Sweeps have settled that change velocities by less than this part of the fastest.
constexpr double settled = 1e-14;

class Jams {
 public:
  Jams(const TurningState& state, double still, int halvings)
      : state_(state), still_(still), most_sweeps_(most_sweeps >> halvings) {
    for (const BodyState& s : state.states) {
      before_.push_back(s.twist);
    }
    for (std::size_t i = 0; i < state.bodies.size(); ++i) {
      fastest_ = std::max(fastest_,
                          before_[i].linear.norm() + before_[i].angular.norm() * state.radius[i]);
    }
    for (const Touch& touch : state.touches) {
      fastest_ = std::max(fastest_, touch.belt.norm());
      now_.push_back(look_at(touch, state.states[touch.a], state.states[touch.b]));
      const Vector3& n = now_.back().normal;
      Vector3 t1 = n.unitOrthogonal();
      Vector3 t2 = n.cross(t1);
      if (state.joints != nullptr) {
        const ContactSystem bodies{state.bodies, {}, state.joints};
        std::tie(t1, t2) = contact_tangents(bodies, touch.a, touch.b, now_.back().point_b, n, t1);
      }
      std::array<ContactRow, 3> rows;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Vector3 d = axis == 0 ? n : axis == 1 ? t1 : t2;
        rows[axis] = {touch.a, touch.b, d, now_.back().point_a - state.bodies[touch.a].position,
                      now_.back().point_b - state.bodies[touch.b].position};
      }
      local_.push_back({state.bodies, {rows.begin(), rows.end()}, state.joints});
      coupling_.push_back(local_.back().coupling());
    }
  }

  [[nodiscard]] std::optional<Jam> find() const {
    bool approach = false;
    bool jams = false;
    for (std::size_t k = 0; k < now_.size(); ++k) {
      approach = approach || now_[k].normal.dot(now_[k].velocity) < -roundoff();
      jams = jams || slides_roughly(k) || presses_itself(k, false) || presses_itself(k, true);
    }
    std::optional<Jam> found;
    if (approach) {
      found = sweep(0.0);
    }
    if (!found && jams) {
      found = sweep(roundoff());  // an impact at no speed is that at a vanishing one
    }
    if (found) {
      found->tangential = !approach;
    }
    return found;
  }

 private:
  [[nodiscard]] double roundoff() const { return 64.0 * epsilon * fastest_; }
  [[nodiscard]] Vector3 slip(std::size_t k) const { return now_[k].slip(); }
  [[nodiscard]] double friction(std::size_t k) const {
    return state_.touches[k].rough ? std::numeric_limits<double>::infinity()
                                   : state_.touches[k].friction;
  }

  /// Whether touch k slides with infinite friction.
  [[nodiscard]] bool slides_roughly(std::size_t k) const {
    return state_.touches[k].rough && slip(k).norm() > still_;
  }

  /// Whether what presses touch k together, with the friction of that, does not part it.
  [[nodiscard]] bool presses_itself(std::size_t k, bool others_held) const {
    const double mu = state_.touches[k].friction;
    if (mu == 0.0 || !(slip(k).norm() > still_)) {
      return false;
    }
    ContactSystem held{state_.bodies, {}, state_.joints};
    for (std::size_t j = 0; j < state_.touches.size() && others_held; ++j) {
      const bool sticks = state_.touches[j].friction > 0.0 && !(slip(j).norm() > still_);
      for (std::size_t axis = 0; j != k && axis < (sticks ? 3U : 1U); ++axis) {
        held.rows.push_back(local_[j].rows[axis]);
      }
    }
    ContactRow push = local_[k].rows[0];
    push.direction = now_[k].normal - mu * slip(k).normalized();
    std::vector<Twist> v(state_.bodies.size());
    ContactSystem{state_.bodies, {push}, state_.joints}.push(Eigen::VectorXd::Ones(1), v);
    if (!held.rows.empty()) {
      (void)held.project(v);
    }
    return held.rate(local_[k].rows[0], v) <= 0.0;
  }

  /// Touch by touch, all others as they are. All approach by `more` than they do, m/s.
  [[nodiscard]] std::optional<Jam> sweep(double more) const {
    const std::size_t n = now_.size();
    Jam found{before_, std::vector<char>(n, 0)};
    std::vector<Vector3> impulse(n, Vector3::Zero());
    int at_once = n <= most_at_once ? at_once_after : most_sweeps_;
    AtOnce way = n <= most_for_newton ? AtOnce::newton : AtOnce::interior;
    for (int round = 0; round < most_sweeps_; ++round) {
      double changed = 0.0;
      for (std::size_t k = 0; k < n; ++k) {
        const Matrix3 W = coupling_[k];
        if (W(0, 0) == 0.0) {
          continue;  // joints block it
        }
        const Vector3 q = rates(k, found.velocities, more) - W * impulse[k];
        const Vector3 now = coulomb_impulse(W, q, friction(k));
        local_[k].push(now - impulse[k], found.velocities);
        changed = std::max(changed, (W * (now - impulse[k])).norm());
        impulse[k] = now;
      }
      bool ends = changed <= settled * fastest_;
      if (!ends && round == at_once) {
        at_once *= 4;
        ends = settle_at_once(more, way, impulse, found.velocities);
        way = way == AtOnce::newton ? AtOnce::interior : AtOnce::newton;
      }
      if (!ends) {
        continue;
      }
      bool any = false;
      for (std::size_t k = 0; k < n; ++k) {
        found.struck[k] = impulse[k].isZero(0.0) ? 0 : 1;
        found.driven +=
            local_[k].driven_work(impulse[k]) + local_[k].carrying_work(impulse[k], before_);
        any = any || (coupling_[k] * impulse[k]).norm() > 4.0 * roundoff();
      }
      return any ? std::optional(std::move(found)) : std::nullopt;
    }
    return std::nullopt;
  }

  /// Along the normal and the tangents of a touch, approaching by `more` than it does, m/s.
  [[nodiscard]] Vector3 rates(std::size_t k, const std::vector<Twist>& velocities,
                              double more) const {
    Vector3 u = local_[k].rates(velocities);
    for (const int axis : {1, 2}) {
      u[axis] +=
          local_[k].rows[static_cast<std::size_t>(axis)].direction.dot(state_.touches[k].belt);
    }
    u.x() -= more;
    return u;
  }

  /// Goes to the nearest that is found at all touches at once from here on; whether it is it.
  bool settle_at_once(double more, AtOnce way, std::vector<Vector3>& impulse,
                      std::vector<Twist>& v) const {
    const std::size_t n = now_.size();
    const auto size = static_cast<Eigen::Index>(3 * n);
    ContactSystem all{state_.bodies, {}, state_.joints};
    ConeProblem problem{{}, Eigen::VectorXd(size), {}};
    Eigen::VectorXd begin(size);
    for (std::size_t k = 0; k < n; ++k) {
      if (coupling_[k](0, 0) == 0.0) {
        return false;
      }
      const auto at = static_cast<Eigen::Index>(3 * k);
      all.rows.insert(all.rows.end(), local_[k].rows.begin(), local_[k].rows.end());
      problem.q.segment<3>(at) = rates(k, before_, more);
      problem.friction.push_back(friction(k));
      begin.segment<3>(at) = impulse[k];
    }
    problem.W = all.coupling();
    const ConeImpulses found = cone_at_once(problem, begin, settled * fastest_, way);
    v = before_;
    for (std::size_t k = 0; k < n; ++k) {
      impulse[k] = found.impulse.segment<3>(static_cast<Eigen::Index>(3 * k));
      local_[k].push(impulse[k], v);
    }
    return found.off <= settled * fastest_;
  }

  const TurningState& state_;
  double still_;
  int most_sweeps_;
  double fastest_ = 0.0;  ///< m/s
  std::vector<Twist> before_;
  std::vector<TouchNow> now_;
  std::vector<ContactSystem> local_;  ///< by touch: along its normal and two tangents
  std::vector<Matrix3> coupling_;
};

}  // namespace

std::optional<Jam> jam(const TurningState& state, double still, int halvings) {
  return Jams(state, still, halvings).find();
}

}  // namespace core
}  // namespace kairos
