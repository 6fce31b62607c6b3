#include "simulation/view/shape_json.hpp"

#include "core/compound_body.hpp"
#include "core/mesh_body.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

namespace kairos {
inline namespace simulation {
namespace {

void add_round(JsonWriter& json, double radius, double length) {
  json.number("radius", radius);
  json.number("length", length);
}

/// Triangles of a mesh that a page draws; of more it draws the box.
constexpr std::size_t most_triangles = 50000;

void add_points(JsonWriter& json, const std::vector<Vector3>& points) {
  json.open("points");
  std::size_t k = 0;
  for (const Vector3& point : points) {
    for (const double coordinate : point) {
      json.number(fmt::format("{}", k++), coordinate);
    }
  }
  json.close();
}

bool add_mesh(JsonWriter& json, const CollisionMesh& mesh) {
  if (mesh.triangles().size() > most_triangles) {
    return false;
  }
  add_points(json, mesh.vertices());
  json.open("triangles");
  std::size_t k = 0;
  for (const Triangle& triangle : mesh.triangles()) {
    for (const std::uint32_t corner : triangle) {
      json.count(fmt::format("{}", k++), static_cast<std::int64_t>(corner));
    }
  }
  json.close();
  return true;
}

void add_parts(JsonWriter& json, const std::vector<CompoundPart>& parts) {
  json.open("parts");
  for (std::size_t k = 0; k < parts.size(); ++k) {
    json.open(fmt::format("{}", k));
    add_shape(json, "shape", parts[k].shape);
    add_vector(json, "place", parts[k].pose.position);
    const Quaternion& q = parts[k].pose.orientation;
    json.open("turn");
    json.number("w", q.w());
    json.number("x", q.x());
    json.number("y", q.y());
    json.number("z", q.z());
    json.close();
    json.close();
  }
  json.close();
}

/// What the box around it does not say of a shape; false where the page draws no more than that.
bool add_sizes(JsonWriter& json, const Shape& shape) {
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    add_round(json, capsule->radius, capsule->length);
  } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    add_round(json, cylinder->radius, cylinder->length);
  } else if (const auto* cone = std::get_if<Cone>(&shape)) {
    add_round(json, cone->radius, cone->height);
  } else if (const auto* hull = std::get_if<Hull>(&shape)) {
    json.number("rounding", hull->rounding);
    add_points(json, hull->core->vertices);
  } else if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    return add_mesh(json, mesh->body->mesh);
  } else if (const auto* compound = std::get_if<Compound>(&shape)) {
    add_parts(json, compound->body->parts);
  } else {
    return std::holds_alternative<Sphere>(shape) || std::holds_alternative<HalfSpace>(shape);
  }
  return true;
}

}  // namespace

void add_vector(JsonWriter& json, std::string_view key, const Vector3& v) {
  json.open(key);
  json.number("x", v.x());
  json.number("y", v.y());
  json.number("z", v.z());
  json.close();
}

void add_shape(JsonWriter& json, std::string_view key, const Shape& shape) {
  const auto* half_space = std::get_if<HalfSpace>(&shape);
  const Vector3 size = half_space ? half_space->normal_B : bounding_box(shape).half_extents;
  json.open(key);
  json.number("x", size.x());
  json.number("y", size.y());
  json.number("z", size.z());
  json.text("kind", add_sizes(json, shape) ? shape_name(shape) : "box");
  json.close();
}

}  // namespace simulation
}  // namespace kairos
