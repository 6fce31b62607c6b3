#pragma once

#include "core/mesh_data.hpp"

namespace kairos {
inline namespace core {

// Closed meshes of known solids, corners counterclockwise seen from outside; for tests, benchmarks
// and examples. Throw `InputError` for counts or sizes that give no mesh.

/// Round z, with `around` sections of `across` corners each: 2 around across triangles. Corners are
/// on the torus, so the mesh is a little smaller: of volume 2 pi^2 R r^2 and of moments
/// I_z = m (R^2 + 3/4 r^2) in the limit.
[[nodiscard]] MeshData torus_mesh(double radius, double tube_radius, int around, int across);
/// An icosahedron with edge 1, each of whose triangles becomes four `levels` times; the new corners
/// are put on its circumscribed sphere if levels > 0.
[[nodiscard]] MeshData icosphere_mesh(int levels);
/// A unit sphere of `rows` rings and `columns` sectors whose radius is 1 + height sin(5 u) sin(4
/// v): 2 (rows - 1) columns triangles.
[[nodiscard]] MeshData bumpy_sphere_mesh(int rows, int columns, double height);
/// A box as twelve triangles.
[[nodiscard]] MeshData box_mesh(const Vector3& half_extents);

}  // namespace core
}  // namespace kairos
