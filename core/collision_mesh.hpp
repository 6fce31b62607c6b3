#pragma once

#include "core/mesh_data.hpp"
#include "core/obb_tree.hpp"

#include <vector>

namespace kairos {
inline namespace core {

/// A mesh that queries are asked of: its triangles and their tree. Const after construction; shared
/// by threads. Vertices 24, triangles 12, tree 40 bytes each: 64 bytes a triangle of a closed mesh.
class CollisionMesh {
 public:
  /// What the triangles mean.
  enum class Kind : std::uint8_t {
    surface,  ///< any triangles; what lies inside does not touch
    solid     ///< what they enclose: closed and oriented, checked; throws `InputError` otherwise
  };

  /// Builds the tree. Throws `InputError` as `build_obb_tree` does, and for a solid that is not
  /// closed.
  explicit CollisionMesh(MeshData data, Kind kind = Kind::surface);

  /// Frame of the mesh, m.
  [[nodiscard]] const std::vector<Vector3>& vertices() const { return data_.vertices; }
  /// Corners by their places in `vertices()`, counterclockwise seen from outside.
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return data_.triangles; }
  /// Boxes around the triangles.
  [[nodiscard]] const ObbTree& tree() const { return tree_; }
  /// Whether the triangles bound a solid.
  [[nodiscard]] bool solid() const { return kind_ == Kind::solid; }
  /// For a solid: one vertex of each connected part of its surface.
  [[nodiscard]] const std::vector<std::uint32_t>& part_vertices() const { return part_vertices_; }
  /// Memory of triangles and tree, bytes.
  [[nodiscard]] std::size_t memory() const;

 private:
  MeshData data_;
  ObbTree tree_;
  Kind kind_;
  std::vector<std::uint32_t> part_vertices_;
};

/// A mesh where it is. The orientation is taken as the rotation R(q)/|q|^2, which is exact for any
/// doubles: q need be unit only to 1e-3. Positions within 1e12 m.
struct PosedMesh {
  const CollisionMesh& mesh;
  const Pose& pose;
};

}  // namespace core
}  // namespace kairos
