#include "simulation/view/shape_json.hpp"

#include <fmt/format.h>

namespace kairos {
inline namespace simulation {
namespace {

void add_round(JsonWriter& json, double radius, double length) {
  json.number("radius", radius);
  json.number("length", length);
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
    json.open("points");
    std::size_t k = 0;
    for (const Vector3& vertex : hull->core->vertices) {
      for (const double coordinate : vertex) {
        json.number(fmt::format("{}", k++), coordinate);
      }
    }
    json.close();
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
