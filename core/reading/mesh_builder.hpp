#pragma once

#include "core/mesh_data.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kairos {
inline namespace core {

/// A mesh as it was read from a file, and where its triangles come from.
struct MeshFile {
  std::string path;
  MeshData mesh;
  std::vector<std::uint32_t> faces;  ///< of each triangle: the face of the file, from 1
  std::vector<std::uint32_t> lines;  ///< of each triangle: its line; empty for binary files
  std::size_t merged_vertices = 0;   ///< as many repeated the coordinates of another
  std::size_t unused_vertices = 0;   ///< as many were no corner of any face; left out
  std::size_t contrary_normals = 0;  ///< STL: as many stored normals point to the other side
  std::size_t divided_polygons = 0;  ///< faces with more than three corners

  /// "model.obj:12: face 3", for messages about a triangle.
  [[nodiscard]] std::string where(std::size_t triangle) const;
};

/// Makes triangles of what a reader reads: scales, divides polygons, merges equal vertices. Throws
/// `InputError` with file, line and face.
class MeshBuilder {
 public:
  /// `scale`: m per unit of the file.
  MeshBuilder(const std::string& path, double scale);

  /// A vertex, in units of the file. `line` 0: the file is binary.
  void vertex(const Vector3& p, int line);
  /// How many vertices were told.
  [[nodiscard]] std::size_t vertex_count() const { return file_.mesh.vertices.size(); }
  /// A polygon, as a closed walk over vertices that were told; counterclockwise from outside. It is
  /// divided by cutting ears, in the projection along its largest area.
  void face(std::span<const std::uint32_t> corners, int line);
  /// The next face has a normal in the file: where corners and normal disagree is counted.
  void face_normal(const Vector3& normal) { normal_ = normal; }
  /// Throws `InputError` with the file, this line (0: none) and the reason.
  [[noreturn]] void fail(int line, const std::string& reason) const;

  /// Ends the file: merges vertices with equal coordinates, leaves unused ones out.
  [[nodiscard]] MeshFile finish();

 private:
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, int line);
  void divide(std::span<const std::uint32_t> corners, int line);
  [[noreturn]] void fail_to_divide(int line) const;
  void check_normal(std::span<const std::uint32_t> corners);
  void renumber();

  double scale_;
  MeshFile file_;
  std::uint32_t face_ = 0;
  Vector3 normal_ = Vector3::Zero();
  std::vector<std::uint32_t> walk_;  ///< corners of a polygon that are left
};

}  // namespace core
}  // namespace kairos
