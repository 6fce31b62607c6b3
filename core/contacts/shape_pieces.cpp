#include "core/contacts/shape_pieces.hpp"

#include "core/compound_body.hpp"
#include "core/mesh_body.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

/// A triangle as a hull with two faces.
Shape flat_hull(const std::array<Vector3, 3>& x) {
  auto p = std::make_shared<Polytope>();
  p->vertices.assign(x.begin(), x.end());
  const Vector3 n = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
  p->faces.add(std::array<std::uint32_t, 3>{0, 1, 2});
  p->faces.add(std::array<std::uint32_t, 3>{0, 2, 1});
  p->normals = {n, -n};
  for (const auto& [i, j] : {std::array<std::uint32_t, 2>{0, 1}, {0, 2}, {1, 2}}) {
    p->edges.push_back({i, j});
    p->directions.push_back((x[j] - x[i]).normalized());
  }
  p->faces_at.add(std::array<std::uint32_t, 2>{0, 1});
  p->faces_at.add(std::array<std::uint32_t, 2>{0, 1});
  p->faces_at.add(std::array<std::uint32_t, 2>{0, 1});
  p->edges_at.add(std::array<std::uint32_t, 2>{0, 1});
  p->edges_at.add(std::array<std::uint32_t, 2>{0, 2});
  p->edges_at.add(std::array<std::uint32_t, 2>{1, 2});
  for (const Vector3& v : x) {
    p->radius = std::max(p->radius, v.norm());
    p->extent = std::max(p->extent, v.lpNorm<1>());
  }
  return Hull{std::move(p), 0.0};
}

/// How far a point is from the ball around a triangle, m.
double away(const std::array<Vector3, 3>& x, const Vector3& from) {
  const Vector3 middle = (x[0] + x[1] + x[2]) / 3.0;
  const double radius =
      std::max({(x[0] - middle).norm(), (x[1] - middle).norm(), (x[2] - middle).norm()});
  return (middle - from).norm() - radius;
}

}  // namespace

bool has_pieces(const Shape& shape) {
  return std::holds_alternative<Mesh>(shape) || std::holds_alternative<Compound>(shape);
}

std::vector<ShapePiece> pieces_of(const Shape& shape, bool over_plane, const Vector3& near,
                                  double within) {
  if (const auto* compound = std::get_if<Compound>(&shape)) {
    std::vector<ShapePiece> parts;
    for (const CompoundPart& part : compound->body->parts) {
      parts.push_back({part.shape, part.shape, part.pose});
    }
    return parts;
  }
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (mesh == nullptr) {
    return {{shape, shape, {}}};
  }
  if (over_plane) {
    return {{Hull{{mesh->body, &mesh->body->outline}, 0.0}, shape, {}}};
  }
  std::vector<ShapePiece> pieces;
  const std::vector<Vector3>& v = mesh->body->mesh.vertices();
  for (const Triangle& t : mesh->body->mesh.triangles()) {
    const std::array<Vector3, 3> x{v[t[0]], v[t[1]], v[t[2]]};
    if (away(x, near) <= within) {
      MeshData alone{{x.begin(), x.end()}, {{0, 1, 2}}};
      pieces.push_back(
          {flat_hull(x), Mesh{mesh_in_place(std::move(alone), CollisionMesh::Kind::surface)}, {}});
    }
  }
  return pieces;
}

}  // namespace core
}  // namespace kairos
