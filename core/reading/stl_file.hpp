#pragma once

#include "core/reading/mesh_builder.hpp"

#include <string_view>

namespace kairos {
inline namespace core {

/// The triangles of an STL file. It is binary if its length is what its count of triangles asks
/// for, whatever its first bytes say; otherwise text, which begins with `solid`.
void parse_stl(std::string_view bytes, const std::string& path, MeshBuilder& builder);

}  // namespace core
}  // namespace kairos
