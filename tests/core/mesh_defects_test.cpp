#include "core/mesh_defects.hpp"

#include "core/mesh_shapes.hpp"
#include "tests/catch.hpp"

#include <algorithm>

using namespace kairos;

namespace {

std::size_t count(const MeshData& mesh, MeshDefectKind kind) {
  const auto defects = mesh_defects(mesh.vertices, mesh.triangles);
  return static_cast<std::size_t>(std::count_if(
      defects.begin(), defects.end(), [&](const MeshDefect& d) { return d.kind == kind; }));
}

}  // namespace

TEST_CASE("mesh defects: closed meshes have none, and each kind is told", "[meshes]") {
  const MeshData box = box_mesh({1.0, 2.0, 3.0});
  for (const MeshData& mesh : {box, torus_mesh(1.0, 0.25, 18, 10), icosphere_mesh(2)}) {
    CHECK(mesh_defects(mesh.vertices, mesh.triangles).empty());
  }
  MeshData open = box;
  open.triangles.pop_back();
  CHECK(count(open, MeshDefectKind::open) == 3);

  MeshData turned = box;
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  CHECK(count(turned, MeshDefectKind::contrary) == 6);  // three edges, told of both sides

  MeshData twice = box;
  twice.triangles.push_back(twice.triangles[0]);
  CHECK(count(twice, MeshDefectKind::repeated) == 1);
  CHECK(count(twice, MeshDefectKind::non_manifold) == 9);  // three edges with three triangles

  MeshData flat = box;
  flat.vertices.push_back(0.5 * (box.vertices[0] + box.vertices[1]));  // exact: on the edge
  flat.triangles.push_back({0, 1, 8});
  CHECK(count(flat, MeshDefectKind::degenerate) == 1);
}
