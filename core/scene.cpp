#include "core/scene.hpp"

#include "core/document.hpp"

namespace kairos {
inline namespace core {

Shape Body::collision_shape() const {
  if (bounds == Bounds::obb && !std::holds_alternative<HalfSpace>(shape)) {
    return bounding_box(shape);
  }
  return shape;
}

Scene read_scene(const std::string& path, const std::vector<Override>& overrides) {
  return parse_scene(read_text_file(path), path, overrides);
}

}  // namespace core
}  // namespace kairos
