#include "core/model.hpp"

#include "core/error.hpp"
#include "core/island_force.hpp"
#include "core/model_tally.hpp"
#include "core/scene_check.hpp"
#include "core/spin_energy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace kairos {
inline namespace core {
namespace {

constexpr std::size_t no_island = std::numeric_limits<std::size_t>::max();

bool is_sphere(const Shape& shape) { return std::holds_alternative<Sphere>(shape); }

/// Whether moments are equal up to roundoff: equal extents may have been summed in another order.
bool is_spherical(const Vector3& inertia) {
  constexpr double roundoff = 4.0 * std::numeric_limits<double>::epsilon();
  return inertia.maxCoeff() - inertia.minCoeff() <= roundoff * inertia.maxCoeff();
}

/// Groups of bodies that forces and joints couple: the smallest index of each body's group.
std::vector<BodyIndex> group_of(const Scene& scene) {
  std::vector<BodyIndex> group(scene.bodies.size());
  std::iota(group.begin(), group.end(), BodyIndex{0});
  const auto root = [&group](BodyIndex i) {
    while (group[i] != i) {
      i = group[i];
    }
    return i;
  };
  const auto couple = [&](BodyIndex i, BodyIndex j) {
    const BodyIndex a = root(i);
    const BodyIndex b = root(j);
    group[std::max(a, b)] = std::min(a, b);
  };
  for (const SceneForce& force : scene.forces) {
    for (const BodyIndex i : force.bodies) {
      couple(i, force.bodies.front());
    }
  }
  const auto is_free = [&](const JointSide& side) {
    return side.body && scene.bodies[*side.body].entity->mobility() == Mobility::free;
  };
  for (const Joint& joint : scene.joints) {
    if (is_free(joint.a) && is_free(joint.b)) {
      couple(*joint.a.body, *joint.b.body);
    }
  }
  for (BodyIndex i = 0; i < group.size(); ++i) {
    group[i] = root(i);
  }
  return group;
}

}  // namespace

Model::Model(Scene scene, const ModelOptions& options)
    : scene_(std::move(scene)), options_(options) {
  check_scene(scene_);
  choose_bodies();
  choose_forces();
  choose_joints();
  choose_friction();
  choose_rotation();
  choose_pairs();
  choose_islands();
  choose_grips();
  choose_motion();
}

void Model::decide(std::vector<Decision> decisions) {
  for (Decision& decision : decisions) {
    decisions_.push_back(std::move(decision));
  }
}

/// Who moves whom, as what, under which gravity.
void Model::choose_bodies() {
  Tally tally;
  mobility_.reserve(size());
  roles_.reserve(size());
  shapes_.reserve(size());
  gravity_force_.reserve(size());
  for (BodyIndex i = 0; i < size(); ++i) {
    const Body& b = body(i);
    mobility_.push_back(b.drive != nullptr ? Mobility::driven : b.entity->mobility());
    roles_.push_back({mobility_[i] == Mobility::free, b.entity->is_field()});
    shapes_.push_back(b.collision_shape());
    const bool accelerates = scene_.gravity == GravityMode::acceleration;
    const double weight = is_free(i) ? b.G * (accelerates ? b.mass : 1.0) : 0.0;
    gravity_force_.emplace_back(is_free(i) ? Vector3(weight * b.entity->gravity_direction())
                                           : Vector3(Vector3::Zero()));
    if (mobility_[i] == Mobility::fixed) {
      tally.add("never moves", b.name,
                fmt::format("a {} is fixed, and nothing drives it", b.entity->kind()));
    } else if (mobility_[i] == Mobility::driven) {
      tally.add("follows its drive and feels no force", b.name, b.drive->description());
    } else if (weight == 0.0) {
      tally.add("feels no gravity", b.name, "its G is 0");
    }
    if (const double speed = b.entity->surface_velocity(b, b.initial).norm(); speed > 0.0) {
      const bool rough = b.friction > 0.0;
      tally.add(fmt::format("has a belt that runs at {} m/s and carries {}", speed,
                            rough ? "by friction" : "nothing"),
                b.name,
                rough
                    ? "the scene says so; its work is told in the ledger"
                    : "it takes friction to carry: under \"newton\", which has none, it is a wall; "
                      "under \"thesis\" it exchanges momentum with what hits it");
    }
    if (b.bounds == Bounds::obb && is_sphere(b.shape)) {
      tally.add("collides as a box", b.name, "the scene says bounds = \"obb\", as the thesis does");
    }
  }
  for (BodyIndex i = 0; i < size(); ++i) {
    if (is_free(i)) {
      free_by_name_.push_back(i);
    }
  }
  free_by_name_.shrink_to_fit();
  std::sort(free_by_name_.begin(), free_by_name_.end(),
            [&](BodyIndex a, BodyIndex b) { return body(a).name < body(b).name; });
  decide(tally.decisions("bodies"));
  if (const auto& box = scene_.periodic) {
    std::string axes;
    for (std::size_t k = 0; k < 3; ++k) {
      if (box->along[k]) {
        axes += fmt::format("{}{}", axes.empty() ? "" : ", ", "xyz"[k]);
      }
    }
    decide({{"space", "is repeated along " + axes,
             "the scene is periodic: a body meets the images of others; positions go on from box "
             "to box"}});
  }
}

/// What acts beside gravity. A uniform force joins gravity, so that its bodies fall on parabolas.
void Model::choose_forces() {
  Tally tally;
  turned_by_force_.assign(size(), false);
  for (const SceneForce& force : scene_.forces) {
    const std::optional<Vector3> uniform = force.force->uniform();
    std::string names;
    for (const BodyIndex i : force.bodies) {
      names += (names.empty() ? "" : " and ") + body(i).name;
      gravity_force_[i] += uniform.value_or(Vector3::Zero());
      turned_by_force_[i] = turned_by_force_[i] || force.force->involves_rotation();
    }
    tally.add(force.force->description(), names,
              uniform ? "the scene asks for it; the same everywhere, it joins gravity"
              : force.force->conservative()
                  ? "the scene asks for it; it keeps energy, as its potential"
                  : "the scene asks for it; its work is told in the energy ledger");
  }
  decide(tally.decisions("forces"));
}

/// Whose surfaces rub against each other.
void Model::choose_friction() {
  rubs_.assign(size(), false);
  const auto rough = [this](BodyIndex i) { return body(i).friction > 0.0 && !is_field(i); };
  std::size_t rough_bodies = 0;
  for (BodyIndex i = 0; i < size(); ++i) {
    rough_bodies += rough(i) ? 1 : 0;
  }
  Tally tally;
  for (BodyIndex i = 0; i < size(); ++i) {
    rubs_[i] = is_free(i) && rough(i) && rough_bodies > 1;
    has_friction_ = has_friction_ || rubs_[i];
    if (rubs_[i] && !entity(i).rotates()) {
      tally.add("is rubbed and does not turn", body(i).name,
                fmt::format("a {} does not turn: friction takes its velocity and gives no spin; "
                            "the entity \"body\" rolls",
                            entity(i).kind()));
    }
  }
  decide(tally.decisions("friction"));
  if (has_friction_) {
    decide({{"friction",
             fmt::format("Coulomb's, isotropic; of a pair the {} of both coefficients",
                         to_string(scene_.friction_combine)),
             "the scene says so; 0 for a body of which nothing is said, and then for its pairs"},
            {"friction", "spinning friction is left out",
             "a contact resists sliding at its points, not turning about its normal: a ball that "
             "pivots on one point does so for ever, and a face that spins is slowed at the corners "
             "of its patch"}});
  }
}

/// Whose orientation is integrated at all.
void Model::choose_rotation() {
  Tally tally;
  rotates_.reserve(size());
  inertia_.reserve(size());
  for (BodyIndex i = 0; i < size(); ++i) {
    const Body& b = body(i);
    const bool could = is_free(i) && (b.entity->rotates() || is_sphere(shape(i)));
    const bool matters = is_free(i) && b.entity->rotates() &&
                         (!is_sphere(shape(i)) || turned_by_force_[i] || rubs_[i]);
    rotates_.push_back(options_.leave_out_orientation ? matters : could);
    inertia_.push_back({is_free(i) ? b.mass : -1.0, is_free(i) ? b.inertia : Vector3::Zero().eval(),
                        rotates_[i], is_free(i) ? bounding_radius(shape(i)) : 0.0, b.inertia_axes});
    if (is_free(i) && !rotates_[i]) {
      tally.add(
          "orientation is left out", b.name,
          is_sphere(shape(i))
              ? "a sphere looks the same from all sides, and without friction nothing turns it"
              : fmt::format("a {} does not turn", b.entity->kind()));
    } else if (is_free(i)) {
      tally.add("orientation is kept", b.name,
                turned_by_force_[i]               ? "a force turns it or depends on how it turns"
                : rubs_[i] && is_sphere(shape(i)) ? "friction turns it"
                : matters                         ? "impacts can turn it"
                                                  : "leaving it out is switched off");
    }
  }
  decide(tally.decisions("rotation"));
}

/// Which pairs can ever meet.
void Model::choose_pairs() {
  pairs_ = BodyPairs(roles_, !options_.prune_pairs, jointed_pairs());
  const std::size_t all = size() * (size() - 1) / 2;
  const std::size_t tested = pairs_.size();
  decide({{"pairs", fmt::format("{} of {} are tested", tested, all),
           tested == all
               ? "nothing is left out"
               : fmt::format("{} cannot do anything to each other: neither moves freely, "
                             "or a field would act on what does not{}",
                             all - tested, scene_.joints.empty() ? "" : ", or a joint holds them")},
          choose_broad_phase()});
}

/// Looking neighbours up costs more than asking every pair until there are some tens of bodies.
Decision Model::choose_broad_phase() {
  constexpr std::size_t few = 24;
  if (!options_.broad_phase.empty()) {
    broad_phase_ = options_.broad_phase;
    return {"broad phase", std::string(broad_phase_), "it was asked for"};
  }
  broad_phase_ = size() <= few ? every_pair : "cells";
  return {"broad phase", std::string(broad_phase_),
          fmt::format("{} bodies: {}", size(),
                      size() <= few ? "asking every pair costs least"
                                    : "an impact must not cost work over all of them")};
}

/// What must be integrated together.
void Model::choose_islands() {
  island_of_.assign(size(), no_island);
  const std::vector<BodyIndex> group = group_of(scene_);
  std::vector<std::size_t> place(size(), 0);
  for (const BodyIndex i : free_by_name_) {
    std::size_t& of_group = island_of_[group[i]];
    if (of_group == no_island) {
      of_group = islands_.size();
      islands_.emplace_back();
    }
    island_of_[i] = of_group;
    Island& island = islands_[of_group];
    place[i] = island.bodies.size();
    island.bodies.push_back(i);
    island.inertia.push_back(inertia_[i]);
    island.constant_force.push_back(gravity_force_[i]);
  }
  for (const SceneForce& force : scene_.forces) {
    if (force.bodies.size() > IslandForce::most_bodies) {
      throw InputError(scene_.path, 0, "force",
                       fmt::format("acts on {} bodies; allowed: at most {}", force.bodies.size(),
                                   IslandForce::most_bodies));
    }
    if (force.bodies.empty() || force.force->uniform()) {
      continue;  // nothing to do, or part of gravity
    }
    Island& island = islands_[island_of_[force.bodies.front()]];
    std::vector<std::size_t> places;
    for (const BodyIndex i : force.bodies) {
      places.push_back(place[i]);
    }
    // Most forces act on all bodies of their island, in its order. They need no `IslandForce`.
    if (force.bodies == island.bodies) {
      island_forces_.push_back(force.force);
    } else {
      island_forces_.push_back(std::make_shared<const IslandForce>(force.force, places));
    }
    island.forces.push_back(island_forces_.back().get());
  }
  islands_.shrink_to_fit();
  build_joints(place);
  for (const Island& island : islands_) {
    if (island.bodies.size() > 1) {
      decide({{"islands",
               fmt::format("{} bodies from \"{}\" on are integrated together", island.bodies.size(),
                           body(island.bodies.front()).name),
               island.joints == nullptr ? "forces couple them" : "joints couple them"}});
    }
  }
}

/// Which hand holds what.
void Model::choose_grips() {
  for (BodyIndex hand = 0; hand < size(); ++hand) {
    if (!entity(hand).is_hand()) {
      continue;
    }
    const auto held = std::find_if(scene_.bodies.begin(), scene_.bodies.end(),
                                   [&](const Body& b) { return b.name == body(hand).holds; });
    const auto i = static_cast<BodyIndex>(held - scene_.bodies.begin());
    if (islands_[island_of_[i]].bodies.size() > 1 || jointed_[i]) {
      throw InputError(scene_.path, body(hand).line, fmt::format("body.{}.holds", body(hand).name),
                       fmt::format("forces or joints couple \"{}\" to others; a hand holds a body "
                                   "that moves by itself",
                                   body(i).name));
    }
    grips_.push_back({hand, i});
    decide({{"hands",
             fmt::format("\"{}\" carries \"{}\" while its fist is closed", body(hand).name,
                         body(i).name),
             "what is held has no contacts until it is released and clear of the hand"}});
  }
}

/// Whether the angular velocity stays what it is between impacts, whatever impacts there will be.
bool Model::keeps_constant_rate(BodyIndex i) const {
  if (!rotates(i) || is_spherical(inertia_[i].principal)) {
    return true;
  }
  const BodyState& s = body(i).initial;
  const Vector3 w_B = inertia_[i].principal_axes(s.pose.orientation).conjugate() * s.twist.angular;
  const Vector3 spin = w_B.cross(inertia_[i].principal.cwiseProduct(w_B));
  const auto solid = [this, i](BodyIndex j) { return interacts(i, j) && !is_field(j); };
  for (BodyIndex j = 0; j < size(); ++j) {
    if (solid(j)) {
      return false;
    }
  }
  return spin.isZero(0.0);
}

/// Which islands move in closed form.
void Model::choose_motion() {
  Tally tally;
  for (const Island& island : islands_) {
    const bool parabola = island.constant_acceleration();
    const bool constant_rate = std::all_of(island.bodies.begin(), island.bodies.end(),
                                           [this](BodyIndex i) { return keeps_constant_rate(i); });
    const bool closed = options_.closed_form && parabola && constant_rate;
    const bool tumbles = options_.closed_form && parabola && !constant_rate;
    closed_form_.push_back(closed);
    tumbles_.push_back(tumbles);
    for (const BodyIndex i : island.bodies) {
      tally.add(closed || tumbles ? "closed form" : "integrated", body(i).name,
                closed ? "only constant forces act on it; its rotation is left out or of constant "
                         "rate"
                : tumbles ? "only constant forces act on it; it can tumble, as a free top between "
                            "impacts: elliptic functions"
                : !options_.closed_form ? "closed forms are switched off"
                                        : "a force depends on the state or on time");
    }
  }
  decide(tally.decisions("motion"));
}

State Model::initial_state() const {
  State state;
  state.reserve(size());
  for (const Body& b : scene_.bodies) {
    if (b.drive != nullptr) {
      const Motion motion = b.drive->motion(Instant{}, scene_.duration);
      state.push_back({motion.pose(0.0), motion.twist(0.0)});
    } else {
      state.push_back(b.initial);
    }
  }
  put_onto_joints(state);
  return state;
}

double Model::kinetic_energy(BodyIndex i, const BodyState& state) const {
  if (!is_free(i)) {
    return 0.0;
  }
  const BodyInertia& inertia = inertia_[i];
  const double linear = 0.5 * inertia.mass * state.twist.linear.squaredNorm();
  if (!inertia.rotates) {
    return linear;
  }
  return linear + spin_energy(inertia, state);
}

}  // namespace core
}  // namespace kairos
