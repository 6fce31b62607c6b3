#pragma once

#include "core/mesh_data.hpp"

#include <array>
#include <compare>
#include <cstdint>
#include <vector>

namespace kairos {
inline namespace core {

/// A node of an `ObbTree`, or one of its triangles.
class ObbChild {
 public:
  ObbChild() = default;
  /// Node i of the tree.
  [[nodiscard]] static ObbChild node(std::uint32_t i) { return ObbChild(i); }
  /// Triangle i of the mesh.
  [[nodiscard]] static ObbChild triangle(std::uint32_t i) { return ObbChild(i | leaf_bit); }
  /// Whether it is a triangle.
  [[nodiscard]] bool is_triangle() const { return (code_ & leaf_bit) != 0; }
  /// The i of the node or triangle.
  [[nodiscard]] std::uint32_t index() const { return code_ & ~leaf_bit; }
  /// An arbitrary order, the same on every machine.
  friend auto operator<=>(const ObbChild&, const ObbChild&) = default;

 private:
  static constexpr std::uint32_t leaf_bit = 1U << 31U;
  explicit ObbChild(std::uint32_t code) : code_(code) {}
  std::uint32_t code_ = 0;
};

/// A box around some triangles and its two children, 40 bytes. The box is exactly what these
/// numbers say: the points centre + R y with |y_k| <= half_k, where R = R(q)/|q|^2 is the rotation
/// of the quaternion `turn` (w, x, y, z; whole numbers, so R is rational). It holds the triangles
/// without an error.
struct ObbNode {
  std::array<float, 3> centre;        ///< frame of the mesh, m
  std::array<float, 3> half_extents;  ///< m
  std::array<std::int16_t, 4> turn;
  std::array<ObbChild, 2> children;
};
static_assert(sizeof(ObbNode) == 40);

/// A box as queries want it. Entries of `axes` (columns: its axes in the frame of the mesh) are off
/// by at most one rounding; the rest is exact.
struct ObbBox {
  Matrix3 axes;
  Vector3 centre;
  Vector3 half_extents;
};
/// The box of a node, frame of the mesh.
[[nodiscard]] ObbBox box_of(const ObbNode& node);

/// Oriented boxes around ever fewer triangles of a mesh [Gottschalk1996]: axes from the covariance
/// of the surface, cut across the longest axis at the mean. One node fewer than triangles, the
/// root first; a single triangle has no node.
struct ObbTree {
  std::vector<ObbNode> nodes;
  ObbChild root;
  /// Nodes on the longest way from the root to a triangle: at most `deepest`.
  int depth = 0;
  /// At least |v|_1 of all vertices and |c|_1 of all centres, m: bounds what rounding does.
  double reach = 0.0;

  static constexpr int deepest = 96;
};

/// Throws `InputError` for a mesh without triangles, with more than `most_triangles`, with corners
/// that do not exist, or numbers beyond 1e12.
[[nodiscard]] ObbTree build_obb_tree(const MeshData& mesh);

}  // namespace core
}  // namespace kairos
