#pragma once

#include "core/reading/mesh_builder.hpp"

#include <string_view>

namespace kairos {
inline namespace core {

/// The vertices and faces of a Wavefront OBJ file.
void parse_obj(std::string_view text, const std::string& path, MeshBuilder& builder);

}  // namespace core
}  // namespace kairos
