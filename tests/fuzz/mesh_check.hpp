#pragma once

#include "core/error.hpp"
#include "core/reading/mesh_file.hpp"
#include "tests/fuzz/fuzz_target.hpp"

#include <string>
#include <string_view>

namespace kairos::fuzz {

/// A file of meshes: any bytes are either refused with a reason, or a mesh whose triangles name
/// vertices that are there, all finite and in use, each with its face.
inline void check_mesh_file(std::string_view bytes, const std::string& name) {
  try {
    const MeshFile file = parse_mesh(bytes, name);
    const std::size_t count = file.mesh.triangles.size();
    require(count > 0 && file.faces.size() == count, "a triangle has no face");
    require(file.lines.empty() || file.lines.size() == count, "a triangle has no line");
    std::vector<bool> used(file.mesh.vertices.size());
    for (const Triangle& t : file.mesh.triangles) {
      for (const std::uint32_t corner : t) {
        require(corner < used.size(), "a corner is no vertex");
        used[corner] = true;
      }
    }
    for (std::size_t i = 0; i < used.size(); ++i) {
      require(used[i] && file.mesh.vertices[i].allFinite(), "a vertex is unused or not finite");
    }
  } catch (const InputError& error) {
    require(!error.reason().empty(), "a mesh is refused without a reason");
  }
}

}  // namespace kairos::fuzz
