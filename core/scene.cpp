#include "core/scene.hpp"

namespace kairos {
inline namespace core {

Shape Body::collision_shape() const {
  if (bounds == Bounds::obb && !std::holds_alternative<HalfSpace>(shape)) {
    return bounding_box(shape);
  }
  return shape;
}

}  // namespace core
}  // namespace kairos
