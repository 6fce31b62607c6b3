#pragma once

#include "core/mesh_data.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

/// What keeps a mesh from bounding a solid.
enum class MeshDefectKind {
  degenerate,    ///< the corners of the triangle lie on one line, exactly
  repeated,      ///< another triangle has the same corners
  open,          ///< an edge of it has no other triangle
  non_manifold,  ///< an edge of it has more than two
  contrary,      ///< the triangle on the other side of an edge is turned the other way
};
/// For messages.
[[nodiscard]] std::string_view to_string(MeshDefectKind kind);

/// What is wrong with a mesh as the surface of a solid, and where.
struct MeshDefect {
  MeshDefectKind kind = MeshDefectKind::degenerate;
  std::uint32_t triangle = 0;
  Triangle corners{};  ///< of an edge the first two, otherwise those of the triangle
};

/// All defects, by triangle; one for each edge and triangle that it concerns. A surface may have
/// any of them. Whether it crosses itself is for the tree to say.
[[nodiscard]] std::vector<MeshDefect> mesh_defects(std::span<const Vector3> vertices,
                                                   std::span<const Triangle> triangles);

}  // namespace core
}  // namespace kairos
