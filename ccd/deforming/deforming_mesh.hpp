#pragma once

#include "core/mesh_data.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kairos::ccd {

/// Two vertices of a mesh, the smaller number first.
using MeshEdge = std::array<std::uint32_t, 2>;

/// A node of the tree of a `DeformingMesh`: boxes around its triangles at the start and at the end
/// of the step. Nodes lie in depth-first order: the first child of node i is i + 1.
struct DeformingNode {
  std::array<std::array<double, 3>, 2> lower, upper;  ///< [start, end][axis]
  std::uint32_t leaves = 0;                           ///< triangles below; 1: a leaf
  std::uint32_t parent = 0;                           ///< of the root: itself
};

/// What a triangle answers for: each vertex and each edge belongs to one triangle, the first that
/// has it, so that no pair of a vertex and a face, or of two edges, is asked about twice
/// (representative triangles [Curtis2008]).
struct OwnedFeatures {
  std::array<std::uint32_t, 3> vertices{}, edges{};
  std::uint8_t vertex_count = 0, edge_count = 0;
};

/// A mesh whose triangles stay and whose vertices move, from step to step, on straight lines:
/// cloth, skin, what a solver of finite elements hands on. Its tree of boxes is refit to every
/// step, and built anew where the refit one has become twice as bad (the sum of surface areas over
/// that of the root [Larsson2006]).
class DeformingMesh {
 public:
  /// At rest at the vertices of `mesh` (any unit). Throws `InputError` for a mesh without
  /// triangles, with more than `most_triangles`, with corners that do not exist, or a number that
  /// is not finite.
  explicit DeformingMesh(MeshData mesh);

  /// Begins the next step: each vertex moves from where the last step ended to its place in
  /// `vertices`. Throws `InputError` for another count of vertices, or a number that is not finite;
  /// nothing has changed then.
  void move_to(std::span<const Vector3> vertices);

  /// Where vertices are at the start of the step.
  [[nodiscard]] const std::vector<Vector3>& start() const { return start_; }
  /// Where they are at its end.
  [[nodiscard]] const std::vector<Vector3>& end() const { return end_; }
  /// Corners by their places among the vertices.
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
  /// All edges, each once, ascending.
  [[nodiscard]] const std::vector<MeshEdge>& edges() const { return edges_; }

  /// The boxes; one node for each triangle, and one fewer inside.
  [[nodiscard]] const std::vector<DeformingNode>& nodes() const { return nodes_; }
  /// The triangle of a leaf.
  [[nodiscard]] std::uint32_t triangle_of(std::uint32_t leaf) const { return triangle_of_[leaf]; }
  /// The second child of a node that is no leaf.
  [[nodiscard]] std::uint32_t second_child(std::uint32_t node) const {
    return node + 2 * nodes_[node + 1].leaves;
  }
  /// The vertices and edges that a triangle answers for.
  [[nodiscard]] const OwnedFeatures& owned(std::uint32_t triangle) const {
    return owned_[triangle];
  }
  /// How often the tree was built, at least once.
  [[nodiscard]] std::int64_t builds() const { return builds_; }

 private:
  void own_features();
  void build_tree();
  void refit();
  [[nodiscard]] double badness() const;

  std::vector<Vector3> start_, end_;
  std::vector<Triangle> triangles_;
  std::vector<MeshEdge> edges_;
  std::vector<OwnedFeatures> owned_;
  std::vector<DeformingNode> nodes_;
  std::vector<std::uint32_t> triangle_of_;  ///< by node; of leaves only
  double badness_when_built_ = 0.0;
  std::int64_t builds_ = 0;
};

}  // namespace kairos::ccd
