#include "core/collision_mesh.hpp"

#include "core/mass_properties.hpp"

#include <numeric>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

/// A vertex of each set of triangles that hang together by vertices.
std::vector<std::uint32_t> find_parts(const MeshData& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) {
      parent[i] = parent[parent[i]];
      i = parent[i];
    }
    return i;
  };
  for (const Triangle& t : mesh.triangles) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  }
  std::vector<std::uint32_t> parts;
  std::vector<bool> told(parent.size());
  for (const Triangle& t : mesh.triangles) {
    const std::uint32_t top = root(t[0]);
    if (!told[top]) {
      told[top] = true;
      parts.push_back(t[0]);
    }
  }
  return parts;
}

}  // namespace

CollisionMesh::CollisionMesh(MeshData data, Kind kind)
    : data_(std::move(data)), tree_(build_obb_tree(data_)), kind_(kind) {
  data_.vertices.shrink_to_fit();
  data_.triangles.shrink_to_fit();
  if (solid()) {
    (void)mass_properties(data_.vertices, data_.triangles);  // refuses what has no inside
    part_vertices_ = find_parts(data_);
  }
}

std::size_t CollisionMesh::memory() const {
  return data_.vertices.capacity() * sizeof(Vector3) +
         data_.triangles.capacity() * sizeof(Triangle) + tree_.nodes.capacity() * sizeof(ObbNode);
}

}  // namespace core
}  // namespace kairos
