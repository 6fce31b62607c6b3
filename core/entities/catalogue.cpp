#include "core/entity.hpp"

namespace kairos {
inline namespace core {
namespace entities {

// A new entity is one file, one declaration here and one line in the list below.
EntityType wall();
EntityType ball();
EntityType body();
EntityType conveyor();
EntityType anti_gravity_pad();
EntityType bat();
EntityType hand();
EntityType balloon();

}  // namespace entities

std::span<const EntityType> entity_catalogue() {
  static const EntityType catalogue[] = {
      entities::wall(),
      entities::ball(),
      entities::body(),
      entities::conveyor(),
      entities::anti_gravity_pad(),
      entities::bat(),
      entities::hand(),
      entities::balloon(),
  };
  return catalogue;
}

}  // namespace core
}  // namespace kairos
