#include "core/contacts/turning_island.hpp"

#include <Eigen/Geometry>

#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

/// Contact forces as a force of the island.
class ContactForce final : public Force {
 public:
  explicit ContactForce(const TurningWay& way)
      : group_(way.group), mode_(way.mode), slow_(way.slow) {}

  void add(Instant t, std::span<const BodyState> bodies,
           std::span<Wrench> wrenches) const override {
    if (mode_.implicit) {
      const TurningState state = touching_state(group_, t, bodies);
      const std::vector<TouchNow> now = touches_of(state);
      add_all(state, now, carried_forces(group_, mode_, now), wrenches);
      return;
    }
    const TurningState state = turning_state(group_, t, bodies);
    TurningForces forces(state);
    using Which = TurningForces::Which;
    const Which which =
        mode_.forces.nearly ? Which::nearly_least : forces.of_several(Which::some_of_many);
    add_all(state, forces.now(), forces.solve(directed(mode_, forces.now(), slow_), which).force,
            wrenches);
  }
  [[nodiscard]] double potential(Instant, std::span<const BodyState>) const override { return 0.0; }
  [[nodiscard]] bool conservative() const override { return false; }
  [[nodiscard]] std::string description() const override { return "what holds bodies in touch"; }

 private:
  void add_all(const TurningState& state, const std::vector<TouchNow>& touches,
               const std::vector<Vector3>& force, std::span<Wrench> wrenches) const {
    std::size_t next = 0;
    for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
      if (group_.inertia[i].mass > 0.0) {
        add_to(i, state, touches, force, wrenches[next++]);
      }
    }
  }
  static void add_to(std::size_t i, const TurningState& state, const std::vector<TouchNow>& touches,
                     const std::vector<Vector3>& force, Wrench& wrench) {
    for (std::size_t k = 0; k < state.touches.size(); ++k) {
      const Touch& touch = state.touches[k];
      const TouchNow& now = touches[k];
      for (const auto& [place, point, sign] :
           {std::tuple{touch.a, now.point_a, -1.0}, {touch.b, now.point_b, 1.0}}) {
        if (place == i) {
          const Vector3 f = sign * force[k];
          wrench.force += f;
          wrench.torque += (point - state.states[i].pose.position).cross(f);
        }
      }
    }
  }

  const TurningGroup& group_;
  const TurningMode& mode_;
  double slow_;
};

/// A force on one body, as one of the group's.
class PlacedForce final : public Force {
 public:
  PlacedForce(const Force& force, std::size_t place) : force_(force), place_(place) {}

  void add(Instant t, std::span<const BodyState> bodies,
           std::span<Wrench> wrenches) const override {
    force_.add(t, bodies.subspan(place_, 1), wrenches.subspan(place_, 1));
  }
  [[nodiscard]] double potential(Instant t, std::span<const BodyState> bodies) const override {
    return force_.potential(t, bodies.subspan(place_, 1));
  }
  [[nodiscard]] bool conservative() const override { return force_.conservative(); }
  [[nodiscard]] bool involves_rotation() const override { return force_.involves_rotation(); }
  [[nodiscard]] std::string description() const override { return force_.description(); }

 private:
  const Force& force_;
  std::size_t place_;
};

/// Forces on what joints hold together, or those of the joints.
class MechanismForce final : public Force {
 public:
  /// `place`: of a body of the group in the island.
  MechanismForce(const GroupMechanism& mechanism, std::vector<std::size_t> place, bool of_joints)
      : mechanism_(mechanism), place_(std::move(place)), of_joints_(of_joints) {}

  void add(Instant t, std::span<const BodyState> bodies,
           std::span<Wrench> wrenches) const override {
    add_mechanism_forces(mechanism_, place_, of_joints_, t, bodies, wrenches);
  }
  [[nodiscard]] double potential(Instant, std::span<const BodyState>) const override { return 0.0; }
  [[nodiscard]] bool conservative() const override { return false; }
  [[nodiscard]] std::string description() const override { return "what acts on a mechanism"; }

 private:
  const GroupMechanism& mechanism_;
  std::vector<std::size_t> place_;
  bool of_joints_;
};
}  // namespace

TurningIsland::TurningIsland(const TurningWay& way) {
  const TurningGroup& group = way.group;
  const auto add = [this](std::unique_ptr<const Force> force) {
    island_.forces.push_back(forces_.emplace_back(std::move(force)).get());
  };
  for (const std::size_t i : way.free) {
    for (const Force* const of_one : group.forces[i]) {
      add(std::make_unique<PlacedForce>(*of_one, island_.bodies.size()));
    }
    island_.bodies.push_back(group.bodies[i]);
    island_.inertia.push_back(group.inertia[i]);
    island_.constant_force.push_back(group.constant_force[i]);
  }
  std::vector<std::size_t> place(group.bodies.size(), 0);
  for (std::size_t k = 0; k < way.free.size(); ++k) {
    place[way.free[k]] = k;
  }
  for (const GroupMechanism& mechanism : group.mechanisms) {
    add(std::make_unique<MechanismForce>(mechanism, place, false));
  }
  add(std::make_unique<ContactForce>(way));
  for (const GroupMechanism& mechanism : group.mechanisms) {
    add(std::make_unique<MechanismForce>(mechanism, place, true));
  }
}

}  // namespace core
}  // namespace kairos
