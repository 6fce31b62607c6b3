#pragma once

#include "core/collision_mesh.hpp"
#include "core/polytope.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// A mesh as a body: its triangles and their tree, about the body's origin and axes. It *is* the
/// triangles of the vertices as they are stored.
struct MeshBody {
  /// The triangles alone, without sizes: see `solid_body` and `mesh_in_place`.
  explicit MeshBody(MeshData data, CollisionMesh::Kind kind) : mesh(std::move(data), kind) {}

  CollisionMesh mesh;
  /// Vertices that can be highest along a direction (those of the convex hull, or all if there are
  /// many), and sizes; no faces. Its width is the least extent along the axes; a flat mesh has 1e-3
  /// of its radius instead.
  Polytope outline;
  Vector3 half_extents = Vector3::Zero();    ///< of the box about the origin, m
  double area = 0.0;                         ///< m^2
  double volume = 0.0;                       ///< of a solid, m^3
  Vector3 moments = Vector3::Zero();         ///< of a solid, density 1, principal, kg m^2
  Quaternion axes = Quaternion::Identity();  ///< the principal axes, in those of the vertices
};

/// A body, and where it was: a point x of the body was centre + x.
struct PlacedMesh {
  std::shared_ptr<const MeshBody> body;
  Vector3 centre = Vector3::Zero();
};

/// A solid about its centroid; vertices whose centroid is 0 to roundoff stay bit for bit. Throws
/// `InputError` where nothing is enclosed: see `mass_properties`.
[[nodiscard]] PlacedMesh solid_body(MeshData data);
/// A mesh where it is told, bit for bit. Throws as `CollisionMesh`.
[[nodiscard]] std::shared_ptr<const MeshBody> mesh_in_place(MeshData data,
                                                            CollisionMesh::Kind kind);
/// All lengths times `size`.
[[nodiscard]] std::shared_ptr<const MeshBody> resized(const MeshBody& body, double size);

}  // namespace core
}  // namespace kairos
