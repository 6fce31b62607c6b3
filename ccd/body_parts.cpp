#include "ccd/body_parts.hpp"

#include "ccd/core_of_shape.hpp"
#include "ccd/rounding/rotation_matrix.hpp"

namespace kairos::ccd {

bool has_parts(const Shape& shape) {
  return std::holds_alternative<Mesh>(shape) || std::holds_alternative<Compound>(shape);
}

BodyParts::BodyParts(const Shape& shape, Against against)
    : half_extents_(bounding_box(shape).half_extents) {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    if (against == Against::bodies) {
      mesh_ = mesh->body.get();
    } else {
      convex_ = ConvexCore::of(mesh->body->outline, 0.0);
    }
  } else if (const auto* compound = std::get_if<Compound>(&shape)) {
    compound_ = compound->body.get();
  } else {
    convex_ = core_of(shape);
  }
}

ConvexCore BodyParts::core(ObbChild child, PlacedCore& memory) const {
  if (mesh_ != nullptr) {
    if (child.is_triangle()) {
      return ConvexCore::triangle(mesh_->mesh.vertices().data(),
                                  mesh_->mesh.triangles()[child.index()]);
    }
    const ObbBox box = box_of(node(child));
    memory.core = ConvexCore::box(box.half_extents);
    memory.axes = box.axes;
    memory.centre = box.centre;
    return ConvexCore::placed(memory);
  }
  if (compound_ != nullptr) {
    const CompoundPart& part = compound_->parts[child.index()];
    memory.core = core_of(part.shape);
    memory.axes = rotation_matrix(part.pose.orientation);
    memory.centre = part.pose.position;
    return ConvexCore::placed(memory);
  }
  return convex_;
}

}  // namespace kairos::ccd
