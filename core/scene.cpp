#include "core/scene.hpp"

#include "core/compound_body.hpp"
#include "core/mesh_body.hpp"

namespace kairos {
inline namespace core {
namespace {

/// The box between the least and the greatest coordinates, as the thesis fits it (3.3). Where its
/// middle is not the body's origin it is a compound of one box. A flat mesh gets the box about its
/// origin.
Shape fitted_box(const Mesh& mesh) {
  constexpr double outwards = 1.0 + 0x1p-50;
  constexpr double roundoff = 1e-12;
  const std::vector<Vector3>& vertices = mesh.body->mesh.vertices();
  Vector3 least = vertices.front();
  Vector3 greatest = least;
  for (const Vector3& v : vertices) {
    least = least.cwiseMin(v);
    greatest = greatest.cwiseMax(v);
  }
  const Vector3 middle = 0.5 * (least + greatest);
  const Vector3 half = outwards * (greatest - middle).cwiseMax(middle - least);
  if (middle.cwiseAbs().maxCoeff() <= roundoff * half.maxCoeff() || half.minCoeff() <= 0.0) {
    return bounding_box(mesh);
  }
  return Compound{compound_in_place({{Box{half}, {middle, Quaternion::Identity()}}})};
}

}  // namespace

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
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (bounds == Bounds::obb && !std::holds_alternative<HalfSpace>(shape)) {
    return mesh != nullptr ? fitted_box(*mesh) : Shape(bounding_box(shape));
  }
  if (mesh != nullptr && bounds == Bounds::hull) {
    return Hull{hull_in_place(mesh->body->mesh.vertices())};
  }
  return shape;
}

}  // namespace core
}  // namespace kairos
