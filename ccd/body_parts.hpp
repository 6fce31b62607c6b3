#pragma once

#include "ccd/convex_core.hpp"
#include "core/compound_body.hpp"
#include "core/mesh_body.hpp"

namespace kairos::ccd {

/// Is it made of several convex parts: a mesh or a compound?
[[nodiscard]] bool has_parts(const Shape& shape);

/// A bounded shape as convex parts: the triangles of a mesh under its tree of boxes, the parts of a
/// compound, or the shape itself. Against a half-space a mesh is one part, its outline. Refers to
/// the shape.
class BodyParts {
 public:
  enum class Against { bodies, plane };
  explicit BodyParts(const Shape& shape, Against against = Against::bodies);

  /// Calls visit(ObbChild) for what the body is made of at first.
  template <typename Visit>
  void each_root(const Visit& visit) const {
    if (mesh_ != nullptr) {
      visit(mesh_->mesh.tree().root);
      return;
    }
    const std::size_t count = compound_ != nullptr ? compound_->parts.size() : 1;
    for (std::size_t i = 0; i < count; ++i) {
      visit(ObbChild::triangle(static_cast<std::uint32_t>(i)));
    }
  }
  /// Of a box of the tree.
  [[nodiscard]] const std::array<ObbChild, 2>& children(ObbChild box) const {
    return node(box).children;
  }
  /// A size of what is in a box, m.
  [[nodiscard]] double size(ObbChild box) const {
    const auto& half = node(box).half_extents;
    return static_cast<double>(half[0]) + static_cast<double>(half[1]) +
           static_cast<double>(half[2]);
  }
  /// A convex part (`is_triangle`), or the box around some. It may refer to `memory`.
  [[nodiscard]] ConvexCore core(ObbChild child, PlacedCore& memory) const;
  /// A box around all of it.
  [[nodiscard]] ConvexCore whole() const { return ConvexCore::box(half_extents_); }

 private:
  [[nodiscard]] const ObbNode& node(ObbChild box) const {
    return mesh_->mesh.tree().nodes[box.index()];
  }

  const MeshBody* mesh_ = nullptr;
  const CompoundBody* compound_ = nullptr;
  ConvexCore convex_;
  Vector3 half_extents_;
};

}  // namespace kairos::ccd
