#pragma once

#include "core/reading/mesh_builder.hpp"

#include <string>
#include <string_view>

namespace kairos {
inline namespace core {

/// Reads a mesh by the ending of its name: `.off` (as `parse_off`), `.obj` (Wavefront: v and f;
/// normals, textures, groups, materials, lines and points are skipped, curved surfaces refused),
/// `.stl` (text or binary). `scale`: m per unit of the file (0.001: millimetres). Polygons are
/// divided into triangles; vertices with equal coordinates become one. What is wrong with the
/// surface is for `mesh_defects` to say. Throws `InputError` with file and line, or face.
[[nodiscard]] MeshFile read_mesh(const std::string& path, double scale = 1.0);
/// The same for the bytes of a file.
[[nodiscard]] MeshFile parse_mesh(std::string_view bytes, const std::string& path,
                                  double scale = 1.0);

}  // namespace core
}  // namespace kairos
