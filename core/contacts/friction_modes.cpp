#include "core/contacts/friction_modes.hpp"

#include "core/contacts/friction_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace kairos {
inline namespace core {
namespace {

using Choice = FrictionChoice;
using Does = FrictionChoice::Does;
using Solution = FrictionForces::Solution;
using Touch = FrictionTouch;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double solve_roundoff = FrictionForces::solve_roundoff;
/// Velocities below this part of the fastest one are roundoff of the projection.
constexpr double project_roundoff = 64.0 * epsilon;
/// Up to so many touches all combinations are tried: 3^6.
constexpr std::size_t most_touches = 6;
constexpr const char* turns_in_touch = "a body turns while it touches";
constexpr int most_turns = 50;  ///< of the direction in which something begins to slide

/// The search for the mode of one group: proposes, and asks `FrictionForces` to verify.
class Attempt {
 public:
  Attempt(const ContactGroup& group, const FlatModeOptions& options)
      : group_(group), options_(options), forces_(group), load_(forces_.load()) {
    for (std::size_t i = 0; i < group.bodies.size(); ++i) {
      fastest_ = std::max(fastest_, group.velocities[i].linear.norm() +
                                        group.velocities[i].angular.norm() * group.radius[i]);
    }
    mode_.velocities = group.velocities;
    mode_.accelerations = group.loads;
    const std::size_t n = group.patches.size();
    mode_.kept.assign(n, 0);
    mode_.pressing.assign(n, 0.0);
    mode_.rate.assign(n, 0.0);
    mode_.slip.assign(n, Slip::none);
    mode_.force.assign(n, Vector3::Zero());
    mode_.slip_ends.assign(n, std::numeric_limits<double>::infinity());
  }

  FlatMode result() && {
    if (gather()) {
      if (const std::optional<Solution> found = search()) {
        take(*found);
      } else if (mode_.refusal.empty()) {
        refuse(
            "a body begins to turn (it tips, or its support is beside its centre), or no "
            "contact forces were found that could be verified");
      }
    }
    mode_.solves = forces_.solves();
    return std::move(mode_);
  }

 private:
  bool refuse(std::string why) {
    mode_.refusal = std::move(why);
    return false;
  }

  /// Collects the touches, and the bodies that must not turn.
  bool gather() {
    for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
      Vector3& w = mode_.velocities[i].angular;
      if (group_.round[i] != 0 || w.isZero(0.0)) {
        continue;
      }
      if (w.norm() * group_.radius[i] > project_roundoff * fastest_ || !moves(group_.bodies[i])) {
        return refuse(turns_in_touch);
      }
      w.setZero();
    }
    for (std::size_t p = 0; p < group_.patches.size(); ++p) {
      const GroupPatch& patch = group_.patches[p];
      const ContactManifold& m = patch.manifold;
      Touch t{p, patch.a, patch.b, m.normal, m.normal, m.normal, patch.friction, m.normal};
      const Vector3 v = forces_.relative(t, mode_.velocities);
      const double rate = t.n.dot(v);
      mode_.rate[p] = std::abs(rate);
      if (rate < -patch.rest_speed) {
        return refuse("they approach each other");
      }
      if (rate > patch.rest_speed) {
        continue;
      }
      t.slip = v + patch.drift;
      t.slip -= t.n * t.n.dot(t.slip);
      Vector3 pull = forces_.relative(t, group_.loads);
      pull -= t.n * t.n.dot(pull);
      if (pull.norm() <= 1e-9 * load_) {
        pull = t.slip;
      }
      forces_.add(t, pull);
    }
    return !touches().empty() || refuse("nothing stays in touch");
  }

  [[nodiscard]] const std::vector<Touch>& touches() const { return forces_.touches(); }
  [[nodiscard]] double still() const { return load_ * group_.instant + 64.0 * epsilon * fastest_; }

  [[nodiscard]] Choice as_it_moves(const Touch& t) const {
    const double u = t.slip.norm();
    if (t.mu == 0.0) {
      return {Does::slides, Vector3::Zero()};
    }
    return u > still() ? Choice{Does::slides, t.slip / u} : Choice{Does::sticks, Vector3::Zero()};
  }

  // --- Which way it goes on ---------------------------------------------------------------------

  std::optional<Solution> search() {
    std::vector<Choice> as_is;
    for (const Touch& t : touches()) {
      as_is.push_back(as_it_moves(t));
    }
    if (auto found = attempt(as_is)) {
      return found;
    }
    const std::size_t n = touches().size();
    if (n > most_touches) {
      std::vector<Choice> all = as_is;
      for (Choice& c : all) {
        c.does = c.does == Does::sticks ? Does::begins : c.does;
      }
      if (auto found = attempt(all)) {
        return found;
      }
      refuse("more than 6 patches with friction, which neither stick nor slide together");
      return std::nullopt;
    }
    for (std::size_t changes = 1; changes <= n; ++changes) {
      if (auto found = change(as_is, 0, changes)) {
        return found;
      }
    }
    return std::nullopt;
  }

  /// Tries all choices with so many changes among the touches from `k` on.
  std::optional<Solution> change(std::vector<Choice>& choices, std::size_t k, std::size_t changes) {
    if (changes == 0) {
      return attempt(choices);
    }
    if (k + changes > choices.size()) {
      return std::nullopt;
    }
    const Choice before = choices[k];
    for (const Does does : {Does::begins, Does::opens}) {
      if (does == Does::begins && before.does != Does::sticks) {
        continue;
      }
      choices[k].does = does;
      if (auto found = change(choices, k + 1, changes - 1)) {
        return found;
      }
    }
    choices[k] = before;
    return change(choices, k + 1, changes);
  }

  /// Finds the directions in which touches begin to slide: along their own acceleration.
  std::optional<Solution> attempt(std::vector<Choice> choices) {
    const auto begins = [](const Choice& c) { return c.does == Does::begins; };
    if (std::none_of(choices.begin(), choices.end(), begins)) {
      return forces_.solve(choices);
    }
    for (Choice& c : choices) {
      if (begins(c)) {
        c.direction.setZero();  // without friction first
      }
    }
    for (int turn = 0; turn < most_turns; ++turn) {
      std::optional<Solution> found = forces_.solve(choices);
      if (!found) {
        return std::nullopt;
      }
      double turned = 0.0;
      for (std::size_t k = 0; k < choices.size(); ++k) {
        if (!begins(choices[k])) {
          continue;
        }
        const Touch& t = touches()[k];
        Vector3 a = forces_.relative(t, found->accelerations);
        a -= t.n * t.n.dot(a);
        if (a.norm() <= solve_roundoff * load_) {
          return std::nullopt;
        }
        a.normalize();
        if (!choices[k].direction.isZero(0.0) && a.dot(choices[k].direction) <= 0.0) {
          return std::nullopt;
        }
        turned = std::max(turned, (a - choices[k].direction).norm());
        choices[k].direction = a;
      }
      if (turned <= 16.0 * epsilon) {
        return found;
      }
    }
    return std::nullopt;
  }

  // --- What was found ---------------------------------------------------------------------------

  void take(const Solution& found) {
    mode_.accelerations = found.accelerations;
    bool any = false;
    for (std::size_t k = 0; k < touches().size(); ++k) {
      const Touch& t = touches()[k];
      if (found.choices[k].does == Does::opens) {
        continue;
      }
      mode_.kept[t.patch] = 1;
      mode_.force[t.patch] = found.force[k];
      mode_.pressing[t.patch] = std::max(t.n.dot(found.force[k]), 0.0);
      any = any || mode_.pressing[t.patch] > 0.0;
    }
    if (!any && !options_.unloaded) {
      refuse("nothing presses");
      return;
    }
    forces_.slow_down(found.choices, mode_.velocities);
    clean(found.choices);
    for (std::size_t k = 0; k < touches().size() && mode_.refusal.empty(); ++k) {
      if (found.choices[k].does != Does::opens) {
        follow(touches()[k], found.choices[k]);
      }
    }
  }

  /// Sets roundoff of a solution to zero, but where a contact would then move faster.
  void clean(const std::vector<Choice>& choices) {
    const std::vector<Twist> velocities = mode_.velocities;
    const std::vector<Twist> accelerations = mode_.accelerations;
    for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
      if (!moves(group_.bodies[i])) {
        continue;
      }
      const double r = std::max(group_.radius[i], 1e-300);
      const double v = project_roundoff * fastest_;
      const double a = 0.01 * solve_roundoff * load_;
      for (int axis = 0; axis < 3; ++axis) {
        for (auto& [x, least] : {std::pair<double&, double>{mode_.velocities[i].linear[axis], v},
                                 {mode_.velocities[i].angular[axis], v / r},
                                 {mode_.accelerations[i].linear[axis], a},
                                 {mode_.accelerations[i].angular[axis], a / r}}) {
          x = std::abs(x) <= least ? 0.0 : x;
        }
      }
    }
    ContactSystem held{group_.bodies, {}};
    for (std::size_t k = 0; k < touches().size(); ++k) {
      const Touch& t = touches()[k];
      if (choices[k].does != Does::opens) {
        held.rows.push_back({t.a, t.b, t.n, Vector3::Zero(), Vector3::Zero()});
      }
    }
    held.undo_where_faster(velocities, mode_.velocities);
    held.undo_where_faster(accelerations, mode_.accelerations);
  }

  /// Notes what a touch does from here on, and how long it slides.
  void follow(const Touch& t, const Choice& choice) {
    const GroupPatch& patch = group_.patches[t.patch];
    const Vector3 v = mode_.velocities[t.b].linear - mode_.velocities[t.a].linear;
    Vector3 a = mode_.accelerations[t.b].linear - mode_.accelerations[t.a].linear;
    const bool plane = patch.manifold.face_of_a || patch.manifold.face_of_b;
    if (!plane && (v.norm() > project_roundoff * fastest_ + patch.still_speed ||
                   a.norm() > solve_roundoff * load_)) {
      refuse("a contact moves along a curved surface or over an edge");
      return;
    }
    if (t.mu == 0.0) {
      return;
    }
    mode_.slip[t.patch] = choice.does == Does::sticks   ? Slip::sticks
                          : choice.does == Does::begins ? Slip::begins
                                                        : Slip::slides;
    if (choice.does != Does::slides) {
      return;
    }
    a = forces_.relative(t, mode_.accelerations);
    a -= t.n * t.n.dot(a);
    const double along = a.dot(choice.direction);
    // What completes an accumulation changes the slide, too.
    Vector3 slip = forces_.relative(t, mode_.velocities) + patch.drift;
    slip -= t.n * t.n.dot(slip);
    const double forward = slip.dot(choice.direction);
    if ((slip - forward * choice.direction).norm() > project_roundoff * fastest_ ||
        forward < -project_roundoff * fastest_) {
      refuse("what is left of the bounces would change where a body slides to");
      return;
    }
    // A body that has nearly stopped is on the line on which it stops.
    const bool slow = forward <= 128.0 * still();
    if (!slow && (a - along * choice.direction).norm() > solve_roundoff * load_) {
      mode_.curved = true;
      refuse("a body slides on a curved path");
      return;
    }
    if (along < 0.0) {
      mode_.slip_ends[t.patch] = std::max(forward, 0.0) / -along;
    }
  }

  const ContactGroup& group_;
  const FlatModeOptions& options_;
  FrictionForces forces_;
  double load_;           ///< m/s^2
  double fastest_ = 0.0;  ///< m/s
  FlatMode mode_;
};

/// Whether no touch slides or would: friction has no work to do.
bool idle(const ContactGroup& group, const FlatMode& mode) {
  double load = 0.0;
  for (const Twist& l : group.loads) {
    load = std::max(load, l.linear.norm());
  }
  for (std::size_t p = 0; p < group.patches.size(); ++p) {
    const GroupPatch& patch = group.patches[p];
    if (mode.kept[p] == 0 || patch.friction == 0.0) {
      continue;
    }
    const Twist& va = mode.velocities[patch.a];
    const Twist& vb = mode.velocities[patch.b];
    const Vector3 a = mode.accelerations[patch.b].linear - mode.accelerations[patch.a].linear;
    if (!(vb.linear + patch.drift - va.linear).isZero(0.0) || !a.isZero(0.0) ||
        !va.angular.isZero(0.0) || !vb.angular.isZero(0.0)) {
      return false;
    }
  }
  return true;
}

/// Velocity of b relative to a where they touch, m/s.
Vector3 slip_at(const ContactGroup& group, const GroupPatch& patch, const Vector3& point) {
  const auto at = [&](std::size_t i) {
    const Twist& v = group.velocities[i];
    return Vector3(v.linear + v.angular.cross(point - group.bodies[i].position));
  };
  return at(patch.b) - at(patch.a);
}

/// Without asking for what turns slowly.
FlatMode mode_with_friction(const ContactGroup& group, const FlatModeOptions& options) {
  FlatMode smooth = flat_mode(group, options);
  if (!smooth.refusal.empty() || !idle(group, smooth)) {
    return friction_mode(group, options);
  }
  const std::size_t n = group.patches.size();
  smooth.slip.assign(n, Slip::none);
  smooth.force.assign(n, Vector3::Zero());
  smooth.slip_ends.assign(n, std::numeric_limits<double>::infinity());
  for (std::size_t p = 0; p < n; ++p) {
    const GroupPatch& patch = group.patches[p];
    if (smooth.kept[p] != 0) {
      smooth.slip[p] = patch.friction > 0.0 ? Slip::sticks : Slip::none;
      smooth.force[p] = smooth.pressing[p] * patch.manifold.normal;
    }
  }
  return smooth;
}

/// Of the points of a patch, along its normal, m/s.
double fastest_rate(const ContactGroup& group, const GroupPatch& patch) {
  double fastest = 0.0;
  for (std::size_t k = 0; k < patch.manifold.size; ++k) {
    const Vector3 v = slip_at(group, patch, patch.manifold.points[k].position);
    fastest = std::max(fastest, std::abs(patch.manifold.normal.dot(v)));
  }
  return fastest;
}

/// Whether friction stops all points of a patch on a way as short as the hops that count as rest:
/// v^2 <= 2 mu a h, where hops have u^2 <= 2 a h.
bool stops_at_once(const ContactGroup& group, const GroupPatch& patch) {
  if (!patch.drift.isZero(0.0)) {
    return false;
  }
  const double still = std::sqrt(std::min(patch.friction, 1.0)) * patch.rest_speed;
  for (std::size_t k = 0; k < patch.manifold.size; ++k) {
    const Vector3 v = slip_at(group, patch, patch.manifold.points[k].position);
    const Vector3& n = patch.manifold.normal;
    if (!((v - n * n.dot(v)).norm() <= still)) {
      return false;
    }
  }
  return true;
}

/// The velocities with nothing left of the rates of these patches, nor, where friction stops that
/// at once, of their slip.
std::vector<Twist> held_still(const ContactGroup& group, const std::vector<char>& held) {
  ContactSystem system{group.bodies, {}};
  double fastest = 0.0;
  for (std::size_t i = 0; i < group.bodies.size(); ++i) {
    const Twist& v = group.velocities[i];
    fastest = std::max(fastest, v.linear.norm() + v.angular.norm() * group.radius[i]);
  }
  for (std::size_t p = 0; p < group.patches.size(); ++p) {
    const GroupPatch& patch = group.patches[p];
    const Vector3& n = patch.manifold.normal;
    const bool stops = held[p] != 0 && stops_at_once(group, patch);
    const Vector3 s = n.unitOrthogonal();
    for (std::size_t k = 0; k < patch.manifold.size && held[p] != 0; ++k) {
      const Vector3& point = patch.manifold.points[k].position;
      system.add(patch.a, patch.b, point, n);
      if (stops) {
        system.add(patch.a, patch.b, point, s);
        system.add(patch.a, patch.b, point, n.cross(s));
      }
    }
  }
  std::vector<Twist> v = group.velocities;
  (void)system.project(v);
  const double roundoff = project_roundoff * fastest;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (v[i].angular.norm() * group.radius[i] <= roundoff) {
      v[i].angular.setZero();
    }
    if (v[i].linear.norm() <= roundoff) {
      v[i].linear.setZero();
    }
  }
  return v;
}

/// What turns no faster than what is at rest may, and is pressed so that it stays, is at rest;
/// `refused` where that is not so.
FlatMode laid_still(const ContactGroup& group, const FlatModeOptions& options, FlatMode refused) {
  std::vector<char> held;
  for (const GroupPatch& patch : group.patches) {
    const bool rests = patch.manifold.size > 0 && fastest_rate(group, patch) <= patch.rest_speed;
    held.push_back(rests ? 1 : 0);
  }
  while (std::any_of(held.begin(), held.end(), [](char h) { return h != 0; })) {
    ContactGroup still = group;
    still.velocities = held_still(group, held);
    FlatMode mode = mode_with_friction(still, options);
    mode.solves += refused.solves;
    if (!mode.refusal.empty()) {
      break;
    }
    // What does not press holds nothing still.
    bool fewer = false;
    for (std::size_t p = 0; p < held.size(); ++p) {
      const bool presses = mode.kept[p] != 0 && mode.pressing[p] > 0.0;
      fewer = fewer || (held[p] != 0 && !presses);
      held[p] = held[p] != 0 && presses ? 1 : 0;
    }
    if (!fewer) {
      for (std::size_t p = 0; p < held.size(); ++p) {
        mode.rate[p] = std::max(mode.rate[p], fastest_rate(group, group.patches[p]));
      }
      return mode;
    }
    refused.solves = mode.solves;
  }
  return refused;
}

}  // namespace

bool has_friction(const ContactGroup& group) {
  return std::any_of(group.patches.begin(), group.patches.end(),
                     [](const GroupPatch& patch) { return patch.friction > 0.0; });
}

FlatMode friction_mode(const ContactGroup& group, const FlatModeOptions& options) {
  return Attempt(group, options).result();
}

FlatMode contact_mode(const ContactGroup& group, const FlatModeOptions& options) {
  if (!has_friction(group)) {
    return flat_mode(group, options);
  }
  FlatMode mode = mode_with_friction(group, options);
  return mode.refusal == turns_in_touch ? laid_still(group, options, std::move(mode)) : mode;
}

}  // namespace core
}  // namespace kairos
