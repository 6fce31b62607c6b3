#include "core/entity.hpp"

namespace kairos {
inline namespace core {

// What most entities do: nothing (6.4.2, 6.5, 6.6).

Vector3 Entity::get_force(const Body& /*self*/, const BodyState& /*state*/) const {
  return Vector3::Zero();
}

void Entity::give_momentum(const Body& /*self*/, BodyState& /*state*/, const Gift& /*gift*/) const {
}

void Entity::give_force(Vector3& /*net_force*/, const Vector3& /*force*/) const {}

Vector3 Entity::surface_velocity(const Body& /*self*/, const BodyState& /*state*/) const {
  return Vector3::Zero();
}

Vector3 Entity::tracked_velocity(TrackerMemory& /*memory*/, const BodyState& truth,
                                 double /*interval*/) const {
  return truth.twist.linear;
}

const EntityType* find_entity(std::string_view kind) {
  for (const EntityType& type : entity_catalogue()) {
    if (type.kind == kind) {
      return &type;
    }
  }
  return nullptr;
}

}  // namespace core
}  // namespace kairos
