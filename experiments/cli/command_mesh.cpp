#include "ccd/mesh/mesh_queries.hpp"
#include "core/error.hpp"
#include "core/mass_properties.hpp"
#include "core/mesh_defects.hpp"
#include "core/reading/csv.hpp"
#include "core/reading/mesh_file.hpp"
#include "experiments/cli/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kairos::experiments {
namespace {

struct MeshReport {
  std::vector<std::string> files;
  std::string scale = "1";
  std::size_t most = 20;

  void run() const;
  void tell(const std::string& path, double m_per_unit) const;
};

/// Pairs of triangles that touch, or cross, and share no corner, the lower one first.
std::vector<ccd::TrianglePair> self_crossings(const MeshData& data) {
  const CollisionMesh mesh(data);
  const Pose still;
  ccd::MeshQueries queries;
  std::vector<ccd::TrianglePair> found;
  for (const ccd::TrianglePair pair : queries.touching_pairs({mesh, still}, {mesh, still})) {
    const Triangle& a = data.triangles[pair.a];
    const Triangle& b = data.triangles[pair.b];
    if (pair.a < pair.b && std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) == a.end()) {
      found.push_back(pair);
    }
  }
  return found;
}

std::string detail(const MeshDefect& defect, const MeshData& mesh) {
  const auto at = [&](std::size_t i) {
    const Vector3& v = mesh.vertices[defect.corners[i]];
    return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x(), v.y(), v.z());
  };
  const bool edge = defect.kind >= MeshDefectKind::open;
  return edge ? fmt::format("{} at the edge from {} to {}", to_string(defect.kind), at(0), at(1))
              : fmt::format("{}", to_string(defect.kind));
}

void tell_solid(const MeshData& mesh) {
  try {
    const MassProperties solid = mass_properties(mesh.vertices, mesh.triangles);
    const Vector3& c = solid.centre;
    const Vector3 I = solid.moments / solid.volume;
    std::cout << fmt::format(
        "  solid: volume {:.12g} m^3, centre ({:.12g}, {:.12g}, {:.12g}) m, moments per kg "
        "({:.12g}, "
        "{:.12g}, {:.12g}) m^2\n",
        solid.volume, c.x(), c.y(), c.z(), I.x(), I.y(), I.z());
  } catch (const InputError& error) {
    std::cout << fmt::format("  surface: no solid, it {}\n", error.reason());
  }
}

void MeshReport::tell(const std::string& path, double m_per_unit) const {
  const MeshFile file = read_mesh(path, m_per_unit);
  const MeshData& mesh = file.mesh;
  std::cout << fmt::format(
      "{}: {} triangles, {} vertices ({} merged, {} unused), {} polygons divided\n", path,
      mesh.triangles.size(), mesh.vertices.size(), file.merged_vertices, file.unused_vertices,
      file.divided_polygons);
  tell_solid(mesh);
  const std::vector<MeshDefect> defects = mesh_defects(mesh.vertices, mesh.triangles);
  const std::vector<ccd::TrianglePair> crossings = self_crossings(mesh);
  std::cout << fmt::format("  {} defects, {} pairs of triangles that cross\n", defects.size(),
                           crossings.size());
  for (std::size_t i = 0; i < std::min(most, defects.size()); ++i) {
    std::cout << fmt::format("  {}: {}\n", file.where(defects[i].triangle),
                             detail(defects[i], mesh));
  }
  for (std::size_t i = 0; i < std::min(most, crossings.size()); ++i) {
    std::cout << fmt::format("  {}: crosses {}\n", file.where(crossings[i].a),
                             file.where(crossings[i].b));
  }
}

void MeshReport::run() const {
  const std::optional<double> m_per_unit = parse_number(scale);
  if (!m_per_unit || !(*m_per_unit >= 1e-12)) {
    throw InputError(
        "", 0, "--scale",
        fmt::format("'{}' is not allowed; allowed: a number from 1e-12 (m per unit)", scale));
  }
  for (const std::string& path : files) {
    tell(path, *m_per_unit);
  }
}

}  // namespace

void add_mesh_command(Command& app) {
  const auto report = std::make_shared<MeshReport>();
  Command mesh = app.add_subcommand("mesh", "What is in a mesh file, and what is wrong with it");
  mesh.add_option("files", report->files, "meshes: .off, .obj or .stl")
      .required()
      .type_name("MESH...");
  mesh.add_option("--scale", report->scale, "m per unit of the meshes (0.001: millimetres)")
      .type_name("X")
      .capture_default_str();
  mesh.add_option("--most", report->most, "defects, and crossings, that are told one by one")
      .type_name("N")
      .capture_default_str();
  mesh.footer(
      "Defects by file, line and face: open (an edge with one triangle), non-manifold (with more "
      "than two),\ncontrary (neighbours turned the other way), degenerate (corners on a line), "
      "repeated. Crossings: pairs\nthat touch and share no corner, exactly. A mesh without them is "
      "a solid; with them it can be a surface.");
  mesh.callback([report] { report->run(); });
}

}  // namespace kairos::experiments
