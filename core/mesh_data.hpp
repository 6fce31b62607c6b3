#pragma once

#include "core/pose.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace kairos {
inline namespace core {

/// Corners of a triangle of a mesh, counterclockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// More triangles than a mesh may have are refused where it is read and where a tree is built.
inline constexpr std::size_t most_triangles = 10'000'000;

/// Triangles that share vertices: a surface (any soup of triangles), or what bounds a solid.
struct MeshData {
  std::vector<Vector3> vertices;  ///< body frame, m
  std::vector<Triangle> triangles;
};

}  // namespace core
}  // namespace kairos
