#include "core/contacts/turning_mode.hpp"

#include "core/circular.hpp"
#include "core/contacts/complementarity.hpp"
#include "core/contacts/contact_sweeps.hpp"
#include "core/contacts/routh_impact.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace kairos {
inline namespace core {
namespace {

using Choice = FrictionChoice;
using Does = FrictionChoice::Does;
using Solution = TurningForces::Solution;

constexpr int most_solves = 3000;

/// A solve costs about the cube of the touches, and of many touches more than two would have to
/// change: no search takes longer than one of a dozen.
int most_solves_of(std::size_t touches) {
  const double ratio = 12.0 / static_cast<double>(std::max<std::size_t>(touches, 12));
  return static_cast<int>(most_solves * ratio * ratio * ratio);
}

class Search {
 public:
  Search(const TurningState& state, double still, int halvings)
      : state_(state),
        forces_(state),
        still_(still),
        halvings_(halvings),
        most_solves_(most_solves_of(state.touches.size()) >> halvings) {}

  TurningMode result() {
    if (!search()) {
      mode_.refusal = painleve_case()
                          ? "Painleve's case: sliding friction would press a contact together the "
                            "more the more it presses, and no forces are known; allowed: less "
                            "friction"
                          : "no contact forces were found that could be verified";
    }
    mode_.solves = forces_.solves();
    if (mode_.refusal.empty()) {
      HeldVelocities held = held_velocities(state_, forces_.now(), mode_.choices);
      mode_.velocities = std::move(held.of);
      mode_.driven = held.driven;
    }
    return std::move(mode_);
  }

 private:
  [[nodiscard]] Vector3 slip(std::size_t k) const { return forces_.now()[k].slip(); }

  [[nodiscard]] Choice as_it_moves(std::size_t k) const {
    const Vector3 u = slip(k);
    if (state_.touches[k].friction == 0.0) {
      return {Does::slides, Vector3::Zero()};
    }
    return u.norm() > (state_.touches[k].rough ? state_.touches[k].rest_speed : still_)
               ? Choice{Does::slides, u.normalized()}
               : Choice{Does::sticks, Vector3::Zero()};
  }

  bool search() {
    std::vector<Choice> as_is;
    for (std::size_t k = 0; k < state_.touches.size(); ++k) {
      as_is.push_back(as_it_moves(k));
    }
    if (search(as_is)) {
      return true;
    }
    // What slides no faster than hops that are taken for rest may all stick, or begin to slide.
    std::vector<Choice> at_rest = as_is;
    bool other = false;
    for (std::size_t k = 0; k < at_rest.size(); ++k) {
      if (at_rest[k].does == Does::slides && may_stick(k)) {
        at_rest[k] = {Does::sticks, Vector3::Zero()};
        other = true;
      }
    }
    return other && search(at_rest);
  }

  bool search(const std::vector<Choice>& as_is) {
    contradicted_ = 0.0;
    if (attempt(as_is)) {
      return true;
    }
    const std::vector<Choice> likely = forces_.propose(as_is);
    if (attempt(likely)) {
      return true;
    }
    if (const std::vector<Choice> pressed = forces_.complementary(as_is);
        !pressed.empty() && attempt(pressed)) {
      return true;
    }
    const std::vector<Choice> at_once = forces_.propose_at_once(as_is, halvings_);
    if (!at_once.empty() && attempt(at_once)) {
      return true;
    }
    contradicted_ = forces_.contradiction(at_once.empty() ? as_is : at_once);
    if ((!at_once.empty() && attempt(forces_.fewest(at_once))) || attempt(forces_.fewest(as_is))) {
      return true;
    }
    mode_.searched = true;
    most_ = forces_.solves() + most_solves_;
    for (const std::size_t changes : {1U, 2U}) {
      for (const bool from_likely : {true, false}) {
        std::vector<Choice> choices = from_likely ? likely : as_is;
        if (change(choices, as_is, 0, changes)) {
          return true;
        }
      }
    }
    return false;
  }

  [[nodiscard]] bool may_stick(std::size_t k) const {
    return state_.touches[k].friction > 0.0 && slip(k).norm() <= state_.touches[k].rest_speed;
  }

  /// With so many changes among the touches from `k` on.
  bool change(std::vector<Choice>& choices, const std::vector<Choice>& as_is, std::size_t k,
              std::size_t changes) {
    if (changes == 0) {
      return attempt(choices);
    }
    for (; k + changes <= choices.size(); ++k) {
      const Choice before = choices[k];
      for (const Does does : {Does::opens, Does::sticks, Does::begins, Does::slides}) {
        const bool at_rest = as_is[k].does == Does::sticks;
        const bool possible = does == Does::opens || (does == Does::slides   ? !at_rest
                                                      : does == Does::sticks ? may_stick(k)
                                                                             : at_rest);
        if (!possible || does == before.does) {
          continue;
        }
        choices[k] = {does, does == Does::slides ? as_is[k].direction : Vector3(Vector3::Zero())};
        if (forces_.solves() > most_) {
          return false;
        }
        if (change(choices, as_is, k + 1, changes - 1)) {
          return true;
        }
      }
      choices[k] = before;
    }
    return false;
  }

  /// What begins to slide does so where it then goes: one angle for each, by Newton's method.
  bool attempt(std::vector<Choice> choices) {
    std::vector<std::size_t> begins;
    for (std::size_t k = 0; k < choices.size(); ++k) {
      if (choices[k].does == Does::begins) {
        begins.push_back(k);
      }
    }
    if (begins.empty()) {
      return accept(choices);
    }
    if (!first_directions(choices)) {
      return false;
    }
    return forces_.turn_to_slip(choices) && slides_on(choices, begins) &&
           (sticks_rather(choices, begins) || accept(choices));
  }

  /// What begins to slide without an acceleration sticks, at the edge of its cone: slipping would
  /// only end, and begin again.
  bool sticks_rather(std::vector<Choice> choices, const std::vector<std::size_t>& begins) {
    const Solution found = forces_.moved_by(choices);
    bool some = false;
    for (const std::size_t k : begins) {
      if (choices[k].direction.dot(forces_.acceleration(k, found.accelerations)) <=
          turning_roundoff * forces_.load()) {
        choices[k].does = Does::sticks;
        some = true;
      }
    }
    return some && attempt(std::move(choices));
  }

  /// Where friction is not known to act against yet: the acceleration without it.
  bool first_directions(std::vector<Choice>& choices) {
    const Solution found = forces_.moved_by(choices);
    for (std::size_t k = 0; k < choices.size(); ++k) {
      if (choices[k].does != Does::begins || !choices[k].direction.isZero(0.0)) {
        continue;
      }
      const Vector3& n = forces_.now()[k].normal;
      Vector3 a = forces_.acceleration(k, found.accelerations);
      a -= n * n.dot(a);
      if (a.norm() <= turning_roundoff * forces_.load()) {
        return false;
      }
      choices[k].direction = a.normalized();
    }
    return true;
  }

  /// Whether nothing slides along its friction.
  bool slides_on(const std::vector<Choice>& choices, const std::vector<std::size_t>& begins) {
    const Solution found = forces_.moved_by(choices);
    return std::all_of(begins.begin(), begins.end(), [&](std::size_t k) {
      return choices[k].direction.dot(forces_.acceleration(k, found.accelerations)) >=
             -turning_roundoff * forces_.load();
    });
  }

  bool accept(const std::vector<Choice>& choices) {
    const double most = allowed_where(contradicted_);
    Solution found = forces_.verified(choices, {.most = most});
    if (found.residual > turning_contradiction ||
        found.violation > std::max(most, found.allowed())) {
      return false;
    }
    mode_.flies = std::all_of(choices.begin(), choices.end(),
                              [](const Choice& c) { return c.does == Does::opens; });
    mode_.choices = choices;
    mode_.forces = std::move(found);
    return true;
  }

  /// Whether one of what slides would jam by itself.
  [[nodiscard]] bool painleve_case() const {
    for (std::size_t k = 0; k < state_.touches.size(); ++k) {
      const Touch& touch = state_.touches[k];
      const Vector3 u = slip(k);
      if (touch.friction == 0.0 || !(u.norm() > still_)) {
        continue;
      }
      ContactSystem alone;
      alone.bodies = state_.bodies;
      alone.joints = state_.joints;
      const Vector3& n = forces_.now()[k].normal;
      const Vector3 t1 = u.normalized();
      for (const Vector3& d : {n, t1, Vector3(n.cross(t1))}) {
        alone.add(touch.a, touch.b, forces_.now()[k].point_a, d);
      }
      if (painleve(alone.coupling(), touch.friction, Eigen::Vector2d::UnitX())) {
        return true;
      }
    }
    return false;
  }

  const TurningState& state_;
  TurningForces forces_;
  double still_;
  int halvings_;
  int most_solves_;            ///< of each search
  int most_ = 0;               ///< solves at which this one ends
  double contradicted_ = 0.0;  ///< by touches that others imply, in units of the load
  TurningMode mode_;
};

/// The row along a direction of a touch.
ContactRow row_of(const TurningState& state, const Touch& touch, const TouchNow& now,
                  const Vector3& direction) {
  return {touch.a, touch.b, direction, now.point_a - state.bodies[touch.a].position,
          now.point_b - state.bodies[touch.b].position};
}

std::vector<Twist> velocities_of(const TurningState& state) {
  std::vector<Twist> velocities;
  for (const BodyState& s : state.states) {
    velocities.push_back(s.twist);
  }
  return velocities;
}

}  // namespace

TurningMode turning_mode(const TurningState& state, double still, int halvings) {
  return Search(state, still, halvings).result();
}

double carrying_work(const TurningState& state, std::span<const SweptTouch> touches,
                     std::span<const Vector3> impulses) {
  double work = 0.0;
  for (std::size_t k = 0; k < touches.size(); ++k) {
    const SweptTouch& touch = touches[k];
    for (const auto& [place, point, sign] :
         {std::tuple{touch.a, touch.point_a, 1.0}, {touch.b, touch.point_b, -1.0}}) {
      if (!kairos::moves(state.bodies[place])) {
        const Twist& v = state.states[place].twist;
        work += sign * impulses[k].dot(v.at(point, state.bodies[place].position));
      }
    }
  }
  return work;
}

HeldVelocities held_velocities(const TurningState& state, const std::vector<TouchNow>& now,
                               const std::vector<FrictionChoice>& choices) {
  ContactSystem held;
  held.bodies = state.bodies;
  held.joints = state.joints;
  std::vector<double> wanted;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    if (choices[k].does == Does::opens) {
      continue;
    }
    const Touch& touch = state.touches[k];
    const Vector3& n = now[k].normal;
    const auto row = [&](const Vector3& d, double rate) {
      held.rows.push_back(row_of(state, touch, now[k], d));
      wanted.push_back(rate);
    };
    row(n, 0.0);
    if (choices[k].does == Does::sticks) {
      Vector3 t1 = n.unitOrthogonal();
      Vector3 t2 = n.cross(t1);
      if (state.joints != nullptr) {
        std::tie(t1, t2) = contact_tangents(held, touch.a, touch.b, now[k].point_b, n, t1);
      }
      for (const Vector3& t : {t1, t2}) {
        row(t, -t.dot(touch.belt));
      }
    }
  }
  HeldVelocities velocities{velocities_of(state)};
  const Eigen::Map<const Eigen::VectorXd> rates(wanted.data(),
                                                static_cast<Eigen::Index>(wanted.size()));
  const Eigen::VectorXd rates_then = rates;
  velocities.driven = held.project(velocities.of, &rates_then);
  return velocities;
}

namespace {

/// The same by sweeps, which get on where many touches are redundant.
std::optional<Parting> parting_by_sweeps(const TurningState& state) {
  std::vector<SweptTouch> touches;
  for (const Touch& touch : state.touches) {
    const TouchNow now = look_at(touch, state.states[touch.a], state.states[touch.b]);
    touches.push_back({touch.a, touch.b, now.normal, now.point_a, now.point_b, 0.0});
  }
  std::vector<ContactSweeps::Vector6> velocities;
  double fastest = 0.0;
  for (std::size_t i = 0; i < state.states.size(); ++i) {
    const Twist& v = state.states[i].twist;
    velocities.emplace_back();
    velocities.back() << v.linear, v.angular;
    fastest = std::max(fastest, v.linear.norm() + v.angular.norm() * state.radius[i]);
  }
  constexpr double settled = 1e-13;  // of the fastest; what has come as far as `accepted` will do
  constexpr double accepted = 1e-10;
  const auto swept = ContactSweeps(state.bodies, touches)
                         .sweep(std::move(velocities), {}, {}, settled * fastest, false);
  if (!(swept.changed <= accepted * fastest)) {
    return std::nullopt;
  }
  Parting found;
  for (const auto& v : swept.velocities) {
    found.velocities.push_back({v.head<3>(), v.tail<3>()});
  }
  for (std::size_t k = 0; k < touches.size(); ++k) {
    found.struck.push_back(swept.impulse[k].isZero(0.0) ? 0 : 1);
  }
  found.driven = carrying_work(state, touches, swept.impulse);
  return found;
}

}  // namespace

std::optional<Parting> parting(const TurningState& state) {
  ContactSystem all;
  all.bodies = state.bodies;
  all.joints = state.joints;
  for (const Touch& touch : state.touches) {
    const TouchNow now = look_at(touch, state.states[touch.a], state.states[touch.b]);
    all.rows.push_back(row_of(state, touch, now, now.normal));
  }
  Parting found{velocities_of(state), {}};
  const Eigen::MatrixXd W = all.coupling();
  Eigen::VectorXd rates = all.rates(found.velocities);
  for (Eigen::Index k = 0; k < rates.size(); ++k) {
    if (W(k, k) == 0.0) {
      rates[k] = 0.0;  // joints block it: what is left is roundoff
    }
  }
  const Complementarity impulses = solve_complementarity(W, rates);
  if (!impulses.solved) {
    return state.joints == nullptr ? parting_by_sweeps(state) : std::nullopt;
  }
  all.push(impulses.x, found.velocities);
  found.driven = all.driven_work(impulses.x) + all.carrying_work(impulses.x, found.velocities);
  for (const double impulse : impulses.x) {
    found.struck.push_back(impulse > 0.0 ? 1 : 0);
  }
  return found;
}

namespace {

/// Moves the bodies as impulses along these rows would, were it velocities.
void displace(const ContactSystem& rows, const Eigen::VectorXd& impulses, TurningState& state) {
  std::vector<Twist> step(state.bodies.size());
  rows.push(impulses, step);
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    if (kairos::moves(state.bodies[i])) {
      Pose& pose = state.states[i].pose;
      pose.position += step[i].linear;
      if (!step[i].angular.isZero(0.0)) {
        pose.orientation = rotate(step[i].angular, pose.orientation).normalized();
      }
    }
  }
}

/// The same as by Lemke's method by sweeps, which get on where many touches are redundant: as near
/// as gaps need to be told.
Complementarity clear_by_sweeps(const TurningState& state, const ContactSystem& rows,
                                const Eigen::VectorXd& off) {
  std::vector<SweptTouch> touches;
  std::vector<Vector3> rates;
  for (std::size_t k = 0; k < rows.rows.size(); ++k) {
    const ContactRow& row = rows.rows[k];
    touches.push_back({row.a, row.b, row.direction, rows.bodies[row.a].position + row.arm_a,
                       rows.bodies[row.b].position + row.arm_b, 0.0});
    rates.emplace_back(off[static_cast<Eigen::Index>(k)], 0.0, 0.0);
  }
  const double settled = 1e-6 * off.lpNorm<Eigen::Infinity>();
  const auto swept = ContactSweeps(state.bodies, touches)
                         .sweep(std::vector<ContactSweeps::Vector6>(state.bodies.size(),
                                                                    ContactSweeps::Vector6::Zero()),
                                rates, {}, settled, false, SweptFor::instant);
  Complementarity found;
  found.solved = swept.changed <= 100.0 * settled;
  found.x.resize(off.size());
  for (std::size_t k = 0; k < touches.size(); ++k) {
    found.x[static_cast<Eigen::Index>(k)] = touches[k].normal.dot(swept.impulse[k]);
  }
  return found;
}

}  // namespace

bool put_clear(TurningState& state, std::span<const Clearance> others) {
  ContactSystem all;
  all.bodies = state.bodies;
  all.joints = state.joints;
  const auto touches = static_cast<Eigen::Index>(state.touches.size());
  Eigen::VectorXd off(touches + static_cast<Eigen::Index>(others.size()));
  for (std::size_t k = 0; k < state.touches.size(); ++k) {
    const Touch& touch = state.touches[k];
    const TouchNow now = look_at(touch, state.states[touch.a], state.states[touch.b]);
    all.rows.push_back(row_of(state, touch, now, now.normal));
    off[static_cast<Eigen::Index>(k)] = now.gap - touch.gap;
  }
  for (std::size_t k = 0; k < others.size(); ++k) {
    const Clearance& other = others[k];
    all.add(other.a, other.b, other.point, other.normal);
    off[touches + static_cast<Eigen::Index>(k)] = -other.missing;
  }
  Complementarity found = solve_complementarity(all.coupling(), off);
  if (!found.solved && state.joints == nullptr) {
    found = clear_by_sweeps(state, all, off);
  }
  if (found.solved) {
    displace(all, found.x, state);
  }
  return found.solved;
}

void put_at_gaps(TurningState& state, const std::vector<char>& moves) {
  ContactSystem held;
  held.bodies = state.bodies;
  held.joints = state.joints;
  std::vector<double> off;
  for (std::size_t k = 0; k < state.touches.size(); ++k) {
    if (moves[k] == 0) {
      continue;
    }
    const Touch& touch = state.touches[k];
    const TouchNow now = look_at(touch, state.states[touch.a], state.states[touch.b]);
    held.rows.push_back(row_of(state, touch, now, now.normal));
    off.push_back(now.gap - touch.gap);
  }
  if (held.rows.empty()) {
    return;
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(1e-11);
  decomposition.compute(held.coupling());
  const Eigen::Map<const Eigen::VectorXd> gaps(off.data(), static_cast<Eigen::Index>(off.size()));
  displace(held, -decomposition.solve(gaps), state);
}

}  // namespace core
}  // namespace kairos
