#include "core/scene.hpp"

#include "core/mesh_body.hpp"

namespace kairos {
inline namespace core {

std::string_view to_string(Bounds bounds) {
  switch (bounds) {
    case Bounds::obb:
      return "obb";
    case Bounds::hull:
      return "hull";
    case Bounds::shape:
      break;
  }
  return "shape";
}

Shape Body::collision_shape() const {
  if (bounds == Bounds::obb && !std::holds_alternative<HalfSpace>(shape)) {
    return bounding_box(shape);
  }
  if (const auto* mesh = std::get_if<Mesh>(&shape); mesh != nullptr && bounds == Bounds::hull) {
    return Hull{hull_in_place(mesh->body->mesh.vertices())};
  }
  return shape;
}

}  // namespace core
}  // namespace kairos
