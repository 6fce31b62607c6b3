#include "core/mesh_body.hpp"

#include "core/mass_properties.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

/// To find the hull of more vertices than that takes longer than it saves.
constexpr std::size_t most_hull_points = 2'000;
/// A centroid that is off by less than this part of the extent is the origin.
constexpr double centroid_roundoff = 1e-14;
/// The thickness that a flat mesh is said to have, as a part of its radius.
constexpr double least_width = 1e-3;

std::vector<Vector3> outline_of(const std::vector<Vector3>& vertices) {
  if (vertices.size() <= most_hull_points) {
    try {
      return hull_in_place(vertices)->vertices;
    } catch (const std::invalid_argument&) {  // flat: its outline is all vertices
    }
  }
  return vertices;
}

double area_of(const CollisionMesh& mesh) {
  double area = 0.0;
  for (const Triangle& t : mesh.triangles()) {
    const Vector3& first = mesh.vertices()[t[0]];
    area += 0.5 * (mesh.vertices()[t[1]] - first).cross(mesh.vertices()[t[2]] - first).norm();
  }
  return area;
}

std::shared_ptr<MeshBody> make_body(MeshData data, CollisionMesh::Kind kind) {
  auto body = std::make_shared<MeshBody>(std::move(data), kind);
  body->outline.vertices = outline_of(body->mesh.vertices());
  add_sizes(body->outline);
  body->outline.width = std::max(body->outline.width, least_width * body->outline.radius);
  for (const Vector3& x : body->outline.vertices) {
    body->half_extents = body->half_extents.cwiseMax(x.cwiseAbs());
  }
  body->area = area_of(body->mesh);
  return body;
}

}  // namespace

PlacedMesh solid_body(MeshData data) {
  const Vector3 centre = mass_properties(data.vertices, data.triangles).centre;
  double extent = 0.0;
  for (const Vector3& x : data.vertices) {
    extent = std::max(extent, (x - centre).lpNorm<Eigen::Infinity>());
  }
  PlacedMesh placed;
  if (centre.lpNorm<Eigen::Infinity>() > centroid_roundoff * extent) {
    placed.centre = centre;
    for (Vector3& x : data.vertices) {
      x -= centre;
    }
  }
  placed.body = mesh_in_place(std::move(data), CollisionMesh::Kind::solid);
  return placed;
}

std::shared_ptr<const MeshBody> mesh_in_place(MeshData data, CollisionMesh::Kind kind) {
  const auto body = make_body(std::move(data), kind);
  if (body->mesh.solid()) {
    const MassProperties mass = mass_properties(body->mesh.vertices(), body->mesh.triangles());
    const bool principal = is_principal(mass.inertia);
    body->volume = mass.volume;
    body->moments = principal ? Vector3(mass.inertia.diagonal()) : mass.moments;
    body->axes = principal ? Quaternion(Quaternion::Identity()) : mass.axes;
  }
  return body;
}

std::shared_ptr<const MeshBody> resized(const MeshBody& body, double size) {
  MeshData data{body.mesh.vertices(), body.mesh.triangles()};
  for (Vector3& x : data.vertices) {
    x *= size;
  }
  const auto larger = make_body(std::move(data), body.mesh.solid() ? CollisionMesh::Kind::solid
                                                                   : CollisionMesh::Kind::surface);
  larger->volume = body.volume * (size * size * size);
  larger->moments = body.moments * (size * size * size * size * size);
  larger->axes = body.axes;
  return larger;
}

}  // namespace core
}  // namespace kairos
