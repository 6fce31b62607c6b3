#include "experiments/thesis/entity_survey.hpp"

#include "core/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

namespace kairos::experiments::thesis {
namespace {

/// A class of the catalogue, and the one that it inherits. A test holds the list against the types
/// that the compiler knows.
struct EntityClass {
  std::string_view kind;
  std::string_view name;
  std::string_view parent;
};
constexpr std::array<EntityClass, 8> classes{{
    {"anti-gravity-pad", "AntiGravityPad", "Entity"},
    {"ball", "Ball", "Entity"},
    {"balloon", "Balloon", "Ball"},
    {"bat", "Bat", "Entity"},
    {"body", "RigidBody", "Ball"},
    {"conveyor", "Conveyor", "Entity"},
    {"hand", "Hand", "Entity"},
    {"wall", "Wall", "Entity"},
}};

const EntityClass& class_of(std::string_view kind) {
  return *std::find_if(classes.begin(), classes.end(),
                       [kind](const EntityClass& c) { return c.kind == kind; });
}

/// Base classes, nearest first.
std::vector<std::string> base_classes(const EntityClass& of) {
  std::vector<std::string> names{std::string(of.parent)};
  const auto named = [&](const EntityClass& c) { return c.name == names.back(); };
  for (auto at = std::find_if(classes.begin(), classes.end(), named); at != classes.end();
       at = std::find_if(classes.begin(), classes.end(), named)) {
    names.emplace_back(at->parent);
  }
  return names;
}

std::string_view name_of(PhysicsType type) {
  switch (type) {
    case PhysicsType::wall:
      return "wall";
    case PhysicsType::ball:
      return "ball";
    case PhysicsType::conveyor:
      return "conveyor";
    case PhysicsType::agpad:
      return "agpad";
    case PhysicsType::ttbat:
      return "ttbat";
    case PhysicsType::none:
      break;
  }
  return "none";
}

std::string_view name_of(Mobility mobility) {
  switch (mobility) {
    case Mobility::fixed:
      return "fixed";
    case Mobility::driven:
      return "driven";
    case Mobility::free:
      break;
  }
  return "free";
}

std::string vector_text(const Vector3& v) {
  return v.isZero() ? "0" : fmt::format("({:g}, {:g}, {:g})", v.x(), v.y(), v.z());
}

/// Asks an entity in the middle of a collision: it moves at (1, 2, 0) m/s and is met by a ball of
/// 1 kg at (0, -3, 0) m/s.
std::vector<Answer> ask(const Entity& entity, const Body& self) {
  const BodyState state{{}, {.linear = {1.0, 2.0, 0.0}}};
  const Momentum momentum = entity.get_momentum(self, state);
  const Vector3 force = entity.get_force(self, state);
  BodyState given = state;
  Gift gift;
  gift.from = PhysicsType::ball;
  gift.momentum = {1.0, {0.0, -3.0, 0.0}};
  entity.give_momentum(self, given, gift);
  Vector3 net_force = Vector3::Zero();
  entity.give_force(net_force, {0.0, 1.0, 0.0});
  TrackerMemory memory;
  (void)entity.tracked_velocity(memory, state, 1.0 / 60.0);
  const Vector3 surface = entity.surface_velocity(self, state);
  std::string mass =
      momentum.mass == -1.0 ? "infinite mass" : fmt::format("m = {:g}", momentum.mass);
  return {
      {"get_momentum", "GetMomentum", mass + ", v = " + vector_text(momentum.velocity)},
      {"get_force", "GetPhysForce", vector_text(force)},
      {"give_momentum", "GiveMomentum",
       given.twist.linear == state.twist.linear ? "takes none"
                                                : "v → " + vector_text(given.twist.linear)},
      {"give_force", "GivePhysForce", net_force.isZero() ? "takes none" : "adds it"},
      {"gravity_direction", "Dynamics", vector_text(entity.gravity_direction())},
      {"surface_velocity", "", surface.isZero() ? "at rest" : vector_text(surface)},
      {"tracked_velocity", "SetInputVelocity", memory.primed ? "from positions" : "the true one"},
  };
}

}  // namespace

std::vector<SurveyedEntity> survey_entities() {
  std::vector<SurveyedEntity> survey;
  for (const EntityType& type : entity_catalogue()) {
    std::vector<double> values;
    for (const EntityKey& key : type.keys) {
      values.push_back(key.default_value);
    }
    const std::shared_ptr<const Entity> entity = type.make(values);
    Body self;
    self.entity = entity;
    self.shape = Sphere{0.1};
    self.mass = type.mobility == Mobility::fixed ? -1.0 : 1.0;
    const EntityClass& of = class_of(type.kind);
    survey.push_back({.kind = std::string(type.kind),
                      .class_name = std::string(of.name),
                      .parents = base_classes(of),
                      .physics_type = std::string(name_of(entity->physics_type())),
                      .mobility = std::string(name_of(entity->mobility())),
                      .stationary = entity->stationary(),
                      .field = entity->is_field(),
                      .rotates = entity->rotates(),
                      .source = std::string(type.source),
                      .keys = type.keys,
                      .answers = ask(*entity, self)});
  }
  return survey;
}

}  // namespace kairos::experiments::thesis
