// Which bodies are in touch with a group under `event-driven`, and which of them an impact
// concerns.

#include "core/contacts/complementarity.hpp"
#include "core/joint_system.hpp"
#include "core/schemes/event/event_modes.hpp"
#include "core/schemes/event/gathered_group.hpp"
#include "core/schemes/event/mode_guards.hpp"
#include "core/schemes/event/turning_group.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Where bodies rest on more points than they have ways to move, rates at these contradict each
/// other by what the points are off, and no velocities make all of them nothing. What is left is
/// then to press and not to part: what holds does not strike what draws away. Returns the work of
/// what is driven in that, J.
double press_what_contradicts(const ContactSystem& held, std::span<const double> radius,
                              std::vector<Twist>& v) {
  double fastest = 0.0;
  for (std::size_t k = 0; k < v.size(); ++k) {
    fastest = std::max(fastest, v[k].linear.norm() + v[k].angular.norm() * radius[k]);
  }
  const Eigen::VectorXd left = held.rates(v);
  if (left.size() == 0 || left.maxCoeff() <= 64.0 * epsilon * fastest) {
    return 0.0;
  }
  const Complementarity pull = solve_complementarity(held.coupling(), -left);
  if (!pull.solved) {
    return 0.0;
  }
  held.push(-pull.x, v);
  return held.driven_work(-pull.x) + held.carrying_work(-pull.x, v);
}

/// What is this many times as far away as what touches may come to touch where gaps are made
/// larger.
constexpr double far_away = 8.0;

double finite_radius(const Shape& shape) {
  const double radius = bounding_radius(shape);
  return std::isfinite(radius) ? radius : 0.0;
}

bool is_among(std::span<const BodyIndex> bodies, BodyIndex i) {
  return std::find(bodies.begin(), bodies.end(), i) != bodies.end();
}

}  // namespace

/// Acceleration without contact forces.
Twist EventModes::load(BodyIndex i, const BodyState& state) const {
  if (!run_.model.is_free(i)) {
    return {};
  }
  const BodyInertia& inertia = run_.model.inertia(i);
  const Wrench applied = motions_.acting(i, run_.time, state);
  Twist load{applied.force / inertia.mass, Vector3::Zero()};
  if (inertia.rotates) {
    load.angular = angular_acceleration(inertia, state, applied.torque);
  }
  return load;
}

/// Whether a body has taken very many steps in this frame.
bool EventModes::rattles(BodyIndex i) const {
  return has_turned_[i].steps >= TurningLimits::many_steps &&
         has_turned_[i].frame == std::floor(run_.time.seconds / run_.mean_frame);
}

/// Below this speed along the normal the forces that press allow no hop above the tolerance, m/s:
/// of what rattles, above half of what counts as touch. A light body that rattles under a heavy one
/// on what returns all of its speed hops until the heavy one has come down on it; gaps are no
/// smaller than they must be to be held, so that it would never come down.
double EventModes::rest_speed(BodyIndex a, BodyIndex b, const BodyState& at_a,
                              const BodyState& at_b, const SettleOptions& options) const {
  const double e = run_.model.restitution(a, b);
  double tolerance = accumulation_.rest_tolerance(a, b, e);
  const bool rattling = rattles(a) || rattles(b);
  if (rattling) {
    tolerance = std::max(tolerance, 0.5 * predictor_.touching_gap(a, b));
  }
  const auto accelerated = [this](BodyIndex i) {
    const auto moving = motions_.moving(i);
    const Motion& motion = moving.motion();
    return motion.acceleration(std::min(run_.time - motion.start, motion.duration)).norm();
  };
  double pressing = load(a, at_a).linear.norm() + load(b, at_b).linear.norm();
  if (rattling) {
    pressing += accelerated(a) + accelerated(b);  // by what lies on it, too
  }
  double speeds = at_a.twist.linear.norm() + at_b.twist.linear.norm();
  for (const auto& [i, state] : {std::pair{a, &at_a}, std::pair{b, &at_b}}) {
    const double turns = state->twist.angular.squaredNorm();
    if (!hangs(i) && turns > 0.0 && !std::holds_alternative<Sphere>(run_.model.shape(i))) {
      pressing += turns * finite_radius(run_.model.shape(i));  // corners go round
    }
  }
  if (hangs(a) || hangs(b)) {
    // Joints and springs press, too, and pass on what is roundoff of the fastest; as where hops are
    // judged.
    for (const BodyIndex i : {a, b}) {
      const double turns = (i == a ? at_a : at_b).twist.angular.squaredNorm();
      pressing += accelerated(i);
      pressing += turns > 0.0 ? turns * bounding_radius(run_.model.shape(i)) : 0.0;
      for (const BodyIndex k : hangs(i) ? motions_.island(i) : std::vector<BodyIndex>()) {
        const Twist v = motions_.at(k, run_.time).twist;
        speeds += v.linear.norm() + v.angular.norm() * run_.model.inertia(k).bounding_radius;
      }
    }
  }
  double slow = std::sqrt(2.0 * pressing * tolerance) + 16.0 * epsilon * speeds;
  if (options.unite) {
    // What takes no time ends by what moves less than the tolerance as long as the scene lasts.
    const double time = options.remaining > 0.0 ? options.remaining : run_.epoch();
    slow = std::max(slow, tolerance / time);
  }
  return slow;
}

bool struck_with(const Model& model, std::span<const BodyIndex> seeds, BodyIndex i) {
  if (is_among(seeds, i) || !model.is_free(i)) {
    return is_among(seeds, i);  // what is not free is of no island
  }
  const Island& island = model.islands()[model.island_of(i)];
  return island.joints != nullptr && std::any_of(island.bodies.begin(), island.bodies.end(),
                                                 [&](BodyIndex k) { return is_among(seeds, k); });
}

EventModes::Gathered EventModes::gather(std::span<const BodyIndex> seeds, Instant t,
                                        const SettleOptions& options) {
  Gathered found;
  found.group.instant = at_once * run_.epoch();
  found.remaining = options.remaining;
  const auto state_of = [&](BodyIndex i) {
    const auto elsewhere = std::find_if(options.moved.begin(), options.moved.end(),
                                        [&](const auto& of) { return of.first == i; });
    if (elsewhere != options.moved.end()) {
      return elsewhere->second;
    }
    const bool known =
        run_.model.mobility(i) == Mobility::fixed || struck_with(run_.model, seeds, i);
    return known ? motions_.now(i) : motions_.at(i, t);
  };
  const auto add_one = [&](BodyIndex i) {
    const BodyState state = state_of(i);
    found.bodies.push_back(i);
    found.states.push_back(state);
    found.group.bodies.push_back(group_body(run_.model.inertia(i), state.pose));
    found.group.velocities.push_back(state.twist);
    found.group.loads.push_back(load(i, state));
    found.group.radius.push_back(finite_radius(run_.model.shape(i)));
    found.group.round.push_back(std::holds_alternative<Sphere>(run_.model.shape(i)) ? 1 : 0);
    if (run_.model.is_free(i)) {
      const Island& island = run_.model.islands()[run_.model.island_of(i)];
      if (island.joints != nullptr) {
        found.hangs = "'" + run_.model.body(i).name + "' hangs on a joint";
      } else if (island.bodies.size() > 1) {
        found.hangs = "'" + run_.model.body(i).name + "' hangs on another by a force";
      } else if (!island.forces.empty()) {
        found.varies = i;
      }
    } else if (run_.model.mobility(i) == Mobility::driven && !options.impact) {
      found.driven = i;
    }
  };
  const auto add = [&](BodyIndex i) {
    const Island* const island =
        run_.model.is_free(i) ? &run_.model.islands()[run_.model.island_of(i)] : nullptr;
    if (island == nullptr || !hangs_together(*island)) {
      return add_one(i);
    }
    if (found.has(i)) {
      return;
    }
    GroupMechanism mechanism{{}, island->joints, island->forces};
    if (island->joints != nullptr) {
      mechanism.forces.pop_back();  // those of the joints
    }
    for (const BodyIndex k : island->bodies) {
      mechanism.places.push_back(found.bodies.size());
      add_one(k);
    }
    found.mechanisms.push_back(std::move(mechanism));
  };
  std::vector<BodyIndex> sorted(seeds.begin(), seeds.end());
  std::sort(sorted.begin(), sorted.end(),
            [&](BodyIndex i, BodyIndex j) { return run_.agenda.before(i, j); });
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  for (const BodyIndex i : sorted) {
    add(i);
  }
  std::vector<Neighbour> seen;
  std::vector<BodyIndex> near;
  for (std::size_t k = 0; k < found.bodies.size() && found.refusal.empty(); ++k) {
    const BodyIndex i = found.bodies[k];
    if (!run_.model.is_free(i)) {
      continue;
    }
    seen.clear();
    predictor_.solids_near(i, seen);
    near.clear();
    for (const auto& [j, image] : seen) {
      if (is_zero(image)) {  // what meets across a side goes on as one of its own box first
        near.push_back(j);
      }
    }
    const std::vector<BodyIndex>& held = graph_.partners(i);
    near.insert(near.end(), held.begin(), held.end());
    std::sort(near.begin(), near.end(),
              [&](BodyIndex x, BodyIndex y) { return run_.agenda.before(x, y); });
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const BodyIndex j : near) {
      const auto [a, b] = run_.agenda.before(i, j) ? std::pair{i, j} : std::pair{j, i};
      if (std::find(found.pairs.begin(), found.pairs.end(), std::pair{a, b}) != found.pairs.end()) {
        continue;
      }
      const BodyState at_a = state_of(a);
      const BodyState at_b = state_of(b);
      const double radii =
          bounding_radius(run_.model.shape(a)) + bounding_radius(run_.model.shape(b));
      const double touching = predictor_.touching_gap(a, b);
      const double reach = options.far ? far_away * touching : touching;
      const bool joined = graph_.joins(a, b);
      if (joined && !found.has(j)) {
        add(j);  // the end of the pair is recorded, whatever becomes of it
      }
      if ((at_a.pose.position - at_b.pose.position).norm() > radii + reach) {
        continue;
      }
      const ContactManifold manifold = run_.detector.manifold(
          run_.model.shape(a), at_a.pose, run_.model.shape(b), at_b.pose, reach);
      if (manifold.size == 0) {
        continue;
      }
      const double slow = rest_speed(a, b, at_a, at_b, options);
      double least = infinity;
      double most = -infinity;
      for (std::size_t p = 0; p < manifold.size; ++p) {
        const double rate =
            normal_velocity({manifold.points[p].position, manifold.normal, 0.0}, at_a, at_b);
        least = std::min(least, rate);
        most = std::max(most, rate);
      }
      if (options.turning && least > slow && manifold.size == 1) {
        // The normal where edges cross may not be that of a face nearby.
        const Overlap o =
            run_.detector.overlap(run_.model.shape(a), at_a.pose, run_.model.shape(b), at_b.pose);
        least = normal_velocity({o.point, o.normal, 0.0}, at_a, at_b);
      }
      const bool struck = options.impact && is_among(seeds, a) && is_among(seeds, b);
      const bool elsewhere =
          options.turning ? least > slow || most < -slow : least < -slow || most > slow;
      const bool apart = std::find(options.apart.begin(), options.apart.end(), BodyPair{a, b}) !=
                         options.apart.end();
      double nearest = infinity;
      for (std::size_t p = 0; p < manifold.size; ++p) {
        nearest = std::min(nearest, manifold.points[p].gap);
      }
      const bool beside = options.far && nearest > touching;
      const bool passes = options.impact ? least > slow || (options.held_only && !joined && !struck)
                                         : elsewhere || apart || beside;
      if (passes && !options.near) {
        continue;  // an impact of its own, or parting
      }
      if (!found.has(j)) {
        add(j);
      }
      found.pairs.emplace_back(a, b);
      found.passes.push_back(passes ? 1 : 0);
      const Vector3& n = manifold.normal;
      const double mu = run_.model.friction(a, b);
      const Vector3 drift = mu > 0.0 ? Vector3(belt(b, n) - belt(a, n)) : Vector3(Vector3::Zero());
      // Without `options`: how soon a collapse ends says nothing about speeds along the surface.
      const double still = still_part * rest_speed(a, b, at_a, at_b, {});
      found.group.patches.push_back(
          {found.place(a), found.place(b), manifold, slow, mu, drift, still});
    }
  }
  return found;
}

bool EventModes::holds_island(BodyIndex i) const {
  const std::vector<BodyIndex>& mates = motions_.island(i);
  return std::any_of(mates.begin(), mates.end(), [&](BodyIndex k) { return graph_.holds(k); });
}

std::vector<BodyIndex> EventModes::group(std::span<const BodyIndex> seeds) const {
  std::vector<BodyIndex> bodies;
  const auto add = [&](BodyIndex i) {
    if (run_.model.is_free(i) && std::find(bodies.begin(), bodies.end(), i) == bodies.end()) {
      bodies.push_back(i);
    }
  };
  for (const BodyIndex i : seeds) {
    add(i);
  }
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    for (const BodyIndex j : graph_.partners(bodies[k])) {
      add(j);
    }
    if (hangs_and_touches(bodies[k])) {
      for (const BodyIndex j : motions_.island(bodies[k])) {
        add(j);
      }
    }
  }
  std::sort(bodies.begin(), bodies.end(),
            [&](BodyIndex i, BodyIndex j) { return run_.agenda.before(i, j); });
  return bodies;
}

std::vector<BodyIndex> EventModes::held_by(BodyIndex surface) const {
  std::vector<BodyIndex> bodies;
  for (const BodyIndex i : graph_.partners(surface)) {
    if (run_.model.is_free(i)) {
      bodies.push_back(i);
    }
  }
  std::sort(bodies.begin(), bodies.end(),
            [&](BodyIndex i, BodyIndex j) { return run_.agenda.before(i, j); });
  return bodies;
}

void EventModes::bring_group(std::span<const BodyIndex> bodies, Instant t) {
  for (const BodyIndex i : bodies) {
    motions_.book(i, t);
    motions_.bring(i, t);
    for (const BodyIndex j : graph_.partners(i)) {
      if (run_.model.mobility(j) == Mobility::driven) {
        motions_.bring(j, t);  // it may be struck next
      }
    }
  }
}

// --- Impacts -----------------------------------------------------------------------------------

/// Removes from an impact, within a step of bodies that turn in touch, the rates by which their
/// motion is off: contacts that hold would be parting by them, and pass nothing on. Contacts that
/// part faster take no part in the impact.
void EventModes::still_hold(ContactGroup& group, GroupImpact& impact) const {
  constexpr double off = 1e-9;  // of the speeds; steps err by some 1e-12 of them
  ContactSystem held;
  held.bodies = impact.system.bodies;
  held.joints = impact.system.joints;
  for (std::size_t p = 0; p < impact.pairs.size(); ++p) {
    GroupPatch& patch = group.patches[p];
    const Patch* const joined = graph_.find(impact.pairs[p].first, impact.pairs[p].second);
    if (joined == nullptr || !joined->turns) {
      continue;
    }
    double speeds = 0.0;
    for (const std::size_t k : {patch.a, patch.b}) {
      const Twist& v = impact.velocities[k];
      speeds += v.linear.norm() + v.angular.norm() * group.radius[k];
    }
    patch.rest_speed = std::min(patch.rest_speed, off * speeds);
    for (std::size_t k = 0; k < patch.manifold.size; ++k) {
      held.add(patch.a, patch.b, patch.manifold.points[k].position, patch.manifold.normal);
      if (std::abs(held.rate(held.rows.back(), impact.velocities)) > patch.rest_speed) {
        held.rows.pop_back();
      }
    }
  }
  impact.driven += held.project(impact.velocities);
  impact.driven += press_what_contradicts(held, group.radius, impact.velocities);
}

EventModes::GroupImpact EventModes::impact_group(std::span<const BodyIndex> seeds, Instant t,
                                                 bool all, bool parting) {
  Gathered found = gather(seeds, t, {.impact = true, .held_only = !all, .near = parting});
  GroupImpact impact;
  if (!found.mechanisms.empty()) {
    impact.driven = put_velocities_onto_joints(found.mechanisms, t, found.states);
    for (std::size_t k = 0; k < found.bodies.size(); ++k) {
      found.group.velocities[k] = found.states[k].twist;
    }
  }
  impact.system.joints = group_joints(found.mechanisms, t, found.states);
  impact.refusal = std::move(found.refusal);
  impact.bodies = std::move(found.bodies);
  impact.pairs = std::move(found.pairs);
  impact.system.bodies = std::move(found.group.bodies);
  impact.velocities = std::move(found.group.velocities);
  still_hold(found.group, impact);
  std::vector<double> restitution;
  for (std::size_t p = 0; p < impact.pairs.size(); ++p) {
    const GroupPatch& patch = found.group.patches[p];
    for (std::size_t k = 0; k < patch.manifold.size; ++k) {
      const ContactManifold::Point& point = patch.manifold.points[k];
      impact.system.add(patch.a, patch.b, point.position, patch.manifold.normal);
      if (!parting &&
          impact.system.rate(impact.system.rows.back(), impact.velocities) > patch.rest_speed) {
        impact.system.rows.pop_back();
        continue;
      }
      impact.pair_of_row.push_back(p);
      impact.gaps.push_back(point.gap);
      restitution.push_back(run_.model.restitution(impact.pairs[p].first, impact.pairs[p].second));
    }
  }
  impact.restitution = Eigen::Map<const Eigen::VectorXd>(
      restitution.data(), static_cast<Eigen::Index>(restitution.size()));
  return impact;
}

bool EventModes::stays(BodyIndex a, BodyIndex b, const Contact& contact) const {
  const BodyState& at_a = motions_.now(a);
  const BodyState& at_b = motions_.now(b);
  return normal_velocity(contact, at_a, at_b) <= rest_speed(a, b, at_a, at_b, {});
}

std::optional<EventModes::Approach> EventModes::landing(BodyIndex a, BodyIndex b) const {
  const Patch* const patch = graph_.find(a, b);
  return patch != nullptr && patch->turns ? fastest_points(a, b, manifold(a, b)) : std::nullopt;
}

ContactManifold EventModes::manifold(BodyIndex a, BodyIndex b) const {
  return run_.detector.manifold(run_.model.shape(a), motions_.now(a).pose, run_.model.shape(b),
                                motions_.now(b).pose, predictor_.touching_gap(a, b));
}

/// The middle of the points that approach fastest.
std::optional<EventModes::Approach> EventModes::fastest_points(BodyIndex a, BodyIndex b,
                                                               const ContactManifold& m) const {
  const BodyState& at_a = motions_.now(a);
  const BodyState& at_b = motions_.now(b);
  const auto contact = [&](std::size_t k) {
    return Contact{m.points[k].position, m.normal, m.points[k].gap};
  };
  double fastest = 0.0;
  for (std::size_t k = 0; k < m.size; ++k) {
    fastest = std::min(fastest, normal_velocity(contact(k), at_a, at_b));
  }
  if (!(fastest < 0.0)) {
    return std::nullopt;
  }
  constexpr double alike = 1e-6;  // relative: points this alike land together
  Contact middle{Vector3::Zero(), m.normal, infinity};
  double count = 0.0;
  for (std::size_t k = 0; k < m.size; ++k) {
    if (normal_velocity(contact(k), at_a, at_b) <= (1.0 - alike) * fastest) {
      middle.point += m.points[k].position;
      middle.gap = std::min(middle.gap, m.points[k].gap);
      count += 1.0;
    }
  }
  middle.point /= count;
  return Approach{a, b, middle, -fastest};
}

std::optional<EventModes::Approach> EventModes::approach(const TouchingPair& pair) const {
  const auto& [a, b, manifold, nearest, turns, corners_too] = pair;
  const BodyState& at_a = motions_.now(a);
  const BodyState& at_b = motions_.now(b);
  const double slow = rest_speed(a, b, at_a, at_b, {});
  if (turns) {
    const std::optional<Approach> found = fastest_points(a, b, manifold);
    return found && found->speed > slow ? found : std::nullopt;
  }
  const double rate = normal_velocity(nearest, at_a, at_b);
  if (rate >= -slow && corners_too) {
    if (const std::optional<Approach> corners = fastest_points(a, b, manifold);
        corners && -corners->speed < std::min(rate, -slow)) {
      return corners;
    }
  }
  return rate < -slow ? std::optional(Approach{a, b, nearest, -rate}) : std::nullopt;
}

std::vector<EventModes::TouchingPair> EventModes::touching_pairs(std::span<const BodyIndex> bodies,
                                                                 std::span<const BodyPair> others,
                                                                 bool corners_too) const {
  std::vector<BodyPair> pairs(others.begin(), others.end());
  for (const BodyIndex i : bodies) {
    for (const BodyIndex j : graph_.partners(i)) {
      pairs.push_back(run_.agenda.before(i, j) ? BodyPair{i, j} : BodyPair{j, i});
    }
  }
  const auto by_name = [&](const BodyPair& x, const BodyPair& y) {
    return x.first != y.first ? run_.agenda.before(x.first, y.first)
                              : run_.agenda.before(x.second, y.second);
  };
  std::sort(pairs.begin(), pairs.end(), by_name);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<TouchingPair> touching;
  for (const auto& [a, b] : pairs) {
    TouchingPair pair{a, b, manifold(a, b)};
    if (pair.manifold.size == 0) {
      continue;
    }
    const Patch* const patch = graph_.find(a, b);
    pair.turns = patch != nullptr && patch->turns;
    pair.corners_too = corners_too || has_turned(std::array{a, b});
    if (!pair.turns) {
      const Overlap o = run_.detector.overlap(run_.model.shape(a), motions_.now(a).pose,
                                              run_.model.shape(b), motions_.now(b).pose);
      pair.nearest = {o.point, o.normal, o.gap};
    }
    touching.push_back(pair);
  }
  return touching;
}

std::optional<EventModes::Approach> EventModes::worst_approach(
    std::span<const TouchingPair> pairs) const {
  std::optional<Approach> worst;
  for (const TouchingPair& pair : pairs) {
    const std::optional<Approach> found = approach(pair);
    if (found && (!worst || found->speed > worst->speed)) {
      worst = found;
    }
  }
  return worst;
}

}  // namespace core
}  // namespace kairos
