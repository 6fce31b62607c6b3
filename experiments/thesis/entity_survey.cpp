#include "experiments/thesis/entity_survey.hpp"

#include "core/scene.hpp"

#include <cxxabi.h>
#include <fmt/format.h>

#include <cstdlib>
#include <memory>
#include <typeinfo>

namespace kairos::experiments::thesis {
namespace {

/// The last part of a class's full name.
std::string class_name(const std::type_info& type) {
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> full(
      abi::__cxa_demangle(type.name(), nullptr, nullptr, &status), std::free);
  const std::string name = status == 0 ? full.get() : type.name();
  return name.substr(name.rfind(':') + 1);
}

/// Base classes, nearest first, from the run-time type information that the C++ ABI of GCC and
/// Clang defines (Itanium C++ ABI, 2.9.5): what the compiler knows, not what a list says.
std::vector<std::string> base_classes(const std::type_info& type) {
  std::vector<std::string> names;
  for (const std::type_info* at = &type;;) {
    const auto* derived = dynamic_cast<const abi::__si_class_type_info*>(at);
    if (derived == nullptr) {
      return names;
    }
    at = derived->__base_type;
    names.push_back(class_name(*at));
  }
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
    const Entity& asked = *entity;
    survey.push_back({.kind = std::string(type.kind),
                      .class_name = class_name(typeid(asked)),
                      .parents = base_classes(typeid(asked)),
                      .physics_type = std::string(name_of(entity->physics_type())),
                      .mobility = std::string(name_of(entity->mobility())),
                      .stationary = entity->stationary(),
                      .field = entity->is_field(),
                      .rotates = entity->rotates(),
                      .source = std::string(type.source),
                      .keys = type.keys,
                      .answers = ask(asked, self)});
  }
  return survey;
}

}  // namespace kairos::experiments::thesis
