#include "core/contacts/face_parts.hpp"

#include "core/compound_body.hpp"
#include "core/mesh_body.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// A contact names its face up to this: of a direction, and of the size of the shape.
constexpr double found_again = 1e-6;
/// Points of one plane leave it by roundoff of vertices and poses, of the size of the shape.
constexpr double roundoff = 1e-12;
/// As far as tolerances of detectors go.
constexpr double told = 1e-9;

struct Plane {
  Vector3 normal = Vector3::Zero();  ///< unit, body frame
  double offset = infinity;          ///< m; infinite: none
  double size = 0.0;                 ///< of the shape, m
  double exact = roundoff;           ///< of the size

  [[nodiscard]] double height(const Vector3& x) const { return normal.dot(x) - offset; }
  [[nodiscard]] double slack() const { return exact * size; }
  /// Where the shape has no face there, the plane that the contact tells.
  [[nodiscard]] Plane or_through(const Vector3& outward, const Vector3& at) const {
    return offset < infinity ? *this : Plane{outward, outward.dot(at), size, told};
  }
};

std::array<Vector3, 3> corners(const CollisionMesh& mesh, const Triangle& t) {
  return {mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]]};
}

/// How high a convex shape reaches along a unit direction, m.
double reach(const Shape& shape, const Vector3& n) {
  const double across = std::sqrt(n.x() * n.x() + n.z() * n.z());
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return sphere->radius;
  }
  if (const auto* box = std::get_if<Box>(&shape)) {
    return n.cwiseAbs().dot(box->half_extents);
  }
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    return capsule->radius + 0.5 * capsule->length * std::abs(n.y());
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return 0.5 * cylinder->length * std::abs(n.y()) + cylinder->radius * across;
  }
  if (const auto* cone = std::get_if<Cone>(&shape)) {
    return std::max(0.75 * cone->height * n.y(),
                    cone->radius * across - 0.25 * cone->height * n.y());
  }
  double highest = -infinity;
  const auto& hull = std::get<Hull>(shape);
  for (const Vector3& x : hull.core->vertices) {
    highest = std::max(highest, n.dot(x));
  }
  return highest + hull.rounding;
}

/// A triangle of a plane with this normal.
FacePart triangle_part(const Vector3& normal, const std::array<Vector3, 3>& x) {
  FacePart part;
  for (std::size_t k = 0; k < 3; ++k) {
    Vector3 side = (x[(k + 1) % 3] - x[k]).cross(normal).normalized();
    side = side.dot(x[(k + 2) % 3] - x[k]) > 0.0 ? Vector3(-side) : side;
    part.sides.push_back({side, side.dot(x[k])});
  }
  return part;
}

/// The plane of the triangle that `at` is on; of those that share it the one it is deepest in.
Plane plane_of_mesh(const MeshBody& body, const Vector3& outward, const Vector3& at) {
  const CollisionMesh& mesh = body.mesh;
  Plane plane{Vector3::Zero(), infinity, body.outline.radius, roundoff};
  double least = infinity;
  for (const Triangle& t : mesh.triangles()) {
    const auto x = corners(mesh, t);
    if (std::abs(outward.dot(x[0] - at)) > found_again * plane.size) {
      continue;
    }
    Vector3 n = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
    n = n.dot(outward) < 0.0 ? Vector3(-n) : n;
    if (!((n - outward).norm() <= found_again)) {
      continue;
    }
    double beyond = -infinity;
    for (const TouchRim::Side& side : triangle_part(n, x).sides) {
      beyond = std::max(beyond, side.normal.dot(at) - side.offset);
    }
    if (beyond < least) {
      least = beyond;
      plane.normal = n;
      plane.offset = n.dot(x[0]);
    }
  }
  return plane;
}

/// The outward normal of the face of a convex shape that has about this one; nullopt: none has.
std::optional<Vector3> face_normal(const Shape& shape, const Vector3& outward) {
  const auto near = [&](const Vector3& n) { return (n - outward).norm() <= found_again; };
  const bool round = std::holds_alternative<Cylinder>(shape);
  if (std::holds_alternative<Box>(shape) || round || std::holds_alternative<Cone>(shape)) {
    for (int k = round ? 1 : 0; k < (round ? 2 : 3); ++k) {
      const Vector3 n = outward[k] < 0.0 ? -Vector3::Unit(k) : Vector3(Vector3::Unit(k));
      if (near(n) && (!std::holds_alternative<Cone>(shape) || n.y() < 0.0)) {
        return n;
      }
    }
  } else if (const auto* hull = std::get_if<Hull>(&shape)) {
    const auto& normals = hull->core->normals;
    const auto n = std::find_if(normals.begin(), normals.end(), near);
    return n == normals.end() ? std::nullopt : std::optional(*n);
  }
  return std::nullopt;
}

/// How high a part of a compound reaches along a unit direction, body frame, m.
double top(const CompoundPart& part, const Vector3& n) {
  return reach(part.shape, part.pose.orientation.conjugate() * n) + n.dot(part.pose.position);
}

/// The plane of the part of a compound whose face is nearest to `at`.
Plane plane_of_compound(const CompoundBody& body, const Vector3& outward, const Vector3& at) {
  Plane plane{Vector3::Zero(), infinity, body.radius, roundoff};
  double least = found_again * plane.size;
  for (const CompoundPart& part : body.parts) {
    const auto n = face_normal(part.shape, part.pose.orientation.conjugate() * outward);
    const double away = n ? std::abs(top(part, outward) - outward.dot(at)) : infinity;
    if (away <= least) {
      least = away;
      plane.normal = part.pose.orientation * *n;
      plane.offset = top(part, plane.normal);
    }
  }
  return plane;
}

/// Whether a triangle lies in the plane (0), rises above it (1) or is elsewhere (-1).
int side_of(const Plane& plane, const std::array<Vector3, 3>& x) {
  const double slack = plane.slack();
  bool in = true;
  for (const Vector3& corner : x) {
    const double height = plane.height(corner);
    if (height > slack) {
      return 1;
    }
    in = in && height >= -slack;
  }
  return in ? 0 : -1;
}

/// The face of a convex shape with this outward normal, if it has one.
std::optional<FacePart> face_of(const Shape& shape, const Vector3& outward) {
  const auto* cylinder = std::get_if<Cylinder>(&shape);
  const auto* cone = std::get_if<Cone>(&shape);
  if (cylinder != nullptr || cone != nullptr) {
    FacePart part;
    part.radius = cylinder != nullptr ? cylinder->radius : cone->radius;
    part.axis = Vector3::UnitY();
    return face_normal(shape, outward) ? std::optional(part) : std::nullopt;
  }
  auto sides = sides_of_face(shape, outward);
  return sides ? std::optional(FacePart{std::move(*sides), 0.0, {}, {}}) : std::nullopt;
}

FacePart placed(FacePart part, const Pose& pose) {
  for (TouchRim::Side& side : part.sides) {
    side.normal = pose.orientation * side.normal;
    side.offset += side.normal.dot(pose.position);
  }
  part.middle = pose.to_world(part.middle);
  part.axis = pose.orientation * part.axis;
  return part;
}

}  // namespace

std::vector<FacePart> parts_of_face(const Shape& shape, const Vector3& outward, const Vector3& at) {
  std::vector<FacePart> found;
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    const Plane plane = plane_of_mesh(*mesh->body, outward, at);
    for (const Triangle& t : mesh->body->mesh.triangles()) {
      const auto x = corners(mesh->body->mesh, t);
      if (side_of(plane, x) == 0) {
        found.push_back(triangle_part(plane.normal, x));
      }
    }
  } else if (const auto* compound = std::get_if<Compound>(&shape)) {
    const Plane plane = plane_of_compound(*compound->body, outward, at);
    for (const CompoundPart& part : compound->body->parts) {
      auto face = face_of(part.shape, part.pose.orientation.conjugate() * plane.normal);
      if (face && std::abs(top(part, plane.normal) - plane.offset) <= plane.slack()) {
        found.push_back(placed(std::move(*face), part.pose));
      }
    }
  } else if (auto face = face_of(shape, outward)) {
    found.push_back(std::move(*face));
  }
  return found;
}

std::optional<Shape> above_face(const Shape& shape, const Vector3& outward, const Vector3& at) {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    const Plane plane = plane_of_mesh(*mesh->body, outward, at).or_through(outward, at);
    MeshData above{mesh->body->mesh.vertices(), {}};
    for (const Triangle& t : mesh->body->mesh.triangles()) {
      if (side_of(plane, corners(mesh->body->mesh, t)) > 0) {
        above.triangles.push_back(t);
      }
    }
    if (!above.triangles.empty()) {
      return Mesh{mesh_in_place(std::move(above), CollisionMesh::Kind::surface)};
    }
  } else if (const auto* compound = std::get_if<Compound>(&shape)) {
    const Plane plane = plane_of_compound(*compound->body, outward, at).or_through(outward, at);
    std::vector<CompoundPart> above;
    for (const CompoundPart& part : compound->body->parts) {
      if (top(part, plane.normal) > plane.offset + plane.slack()) {
        above.push_back(part);
      }
    }
    if (!above.empty()) {
      return Compound{compound_in_place(std::move(above))};
    }
  }
  return std::nullopt;
}

}  // namespace core
}  // namespace kairos
