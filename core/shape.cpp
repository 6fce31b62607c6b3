#include "core/shape.hpp"

#include "core/circular.hpp"
#include "core/compound_body.hpp"
#include "core/error.hpp"
#include "core/mesh_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <typename... Cases>
struct Match : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
Match(Cases...) -> Match<Cases...>;

/// Moments about its middle: those of a cylinder and of a ball that is cut in two halves.
Vector3 capsule_inertia(const Capsule& capsule, double mass) {
  const double r = capsule.radius;
  const double L = capsule.length;
  const double ball = mass * (4.0 * r) / (4.0 * r + 3.0 * L);
  const double middle = mass - ball;
  const double along = 0.5 * middle * r * r + 0.4 * ball * r * r;
  const double across =
      middle * (L * L / 12.0 + 0.25 * r * r) + ball * (0.4 * r * r + 0.25 * L * L + 0.375 * L * r);
  return {across, along, across};
}

}  // namespace

std::string_view shape_name(const Shape& shape) {
  return std::visit(Match{[](const Sphere&) -> std::string_view { return "sphere"; },
                          [](const Box&) -> std::string_view { return "box"; },
                          [](const HalfSpace&) -> std::string_view { return "half-space"; },
                          [](const Capsule&) -> std::string_view { return "capsule"; },
                          [](const Cylinder&) -> std::string_view { return "cylinder"; },
                          [](const Cone&) -> std::string_view { return "cone"; },
                          [](const Hull&) -> std::string_view { return "hull"; },
                          [](const Mesh&) -> std::string_view { return "mesh"; },
                          [](const Compound&) -> std::string_view { return "compound"; }},
                    shape);
}

double bounding_radius(const Shape& shape) {
  return std::visit(
      Match{[](const Sphere& sphere) { return sphere.radius; },
            [](const Box& box) { return box.half_extents.norm(); },
            [](const HalfSpace&) { return infinity; },
            [](const Capsule& capsule) { return 0.5 * capsule.length + capsule.radius; },
            [](const Cylinder& c) { return hypotenuse(c.radius, 0.5 * c.length); },
            [](const Cone& cone) {
              return std::max(0.75 * cone.height, hypotenuse(cone.radius, 0.25 * cone.height));
            },
            [](const Hull& hull) { return hull.core->radius + hull.rounding; },
            [](const Mesh& mesh) { return mesh.body->outline.radius; },
            [](const Compound& compound) { return compound.body->radius; }},
      shape);
}

double smallest_extent(const Shape& shape) {
  return std::visit(
      Match{[](const Sphere& sphere) { return 2.0 * sphere.radius; },
            [](const Box& box) { return 2.0 * box.half_extents.minCoeff(); },
            [](const HalfSpace&) { return infinity; },
            [](const Capsule& capsule) { return 2.0 * capsule.radius; },
            [](const Cylinder& c) { return std::min(2.0 * c.radius, c.length); },
            [](const Cone& cone) {  // its height, or from the base's rim to the side opposite
              const double side = hypotenuse(cone.radius, cone.height);
              return std::min(cone.height, 2.0 * cone.radius * cone.height / side);
            },
            [](const Hull& hull) { return hull.core->width + 2.0 * hull.rounding; },
            [](const Mesh& mesh) { return mesh.body->outline.width; },
            [](const Compound& compound) { return compound.body->width; }},
      shape);
}

Vector3 solid_inertia(const Shape& shape, double mass) {
  return std::visit(
      Match{[mass](const Sphere& sphere) -> Vector3 {
              return Vector3::Constant(0.4 * mass * sphere.radius * sphere.radius);
            },
            [mass](const Box& box) -> Vector3 {
              const Vector3 squares = box.half_extents.cwiseAbs2();
              return (mass / 3.0) * (Vector3::Constant(squares.sum()) - squares);
            },
            // A half-space is never free: it has no finite inertia, and nothing asks for it.
            [](const HalfSpace&) -> Vector3 { return Vector3::Zero(); },
            [mass](const Capsule& capsule) -> Vector3 { return capsule_inertia(capsule, mass); },
            [mass](const Cylinder& c) -> Vector3 {
              const double along = 0.5 * mass * c.radius * c.radius;
              const double across = mass * c.length * c.length / 12.0 + 0.5 * along;
              return {across, along, across};
            },
            [mass](const Cone& cone) -> Vector3 {
              const double square = cone.radius * cone.radius;
              const double across = 0.0375 * mass * (4.0 * square + cone.height * cone.height);
              return {across, 0.3 * mass * square, across};
            },
            [mass](const Hull& hull) -> Vector3 {
              return (mass / hull.core->volume) * hull.core->moments;
            },
            [mass](const Mesh& mesh) -> Vector3 {  // a surface encloses nothing
              return mesh.body->mesh.solid()
                         ? Vector3((mass / mesh.body->volume) * mesh.body->moments)
                         : Vector3(Vector3::Zero());
            },
            [mass](const Compound& compound) -> Vector3 {
              return (mass / compound.body->volume) * compound.body->moments;
            }},
      shape);
}

Quaternion solid_axes(const Shape& shape) {
  if (const auto* hull = std::get_if<Hull>(&shape)) {
    return hull->core->axes;
  }
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    return mesh->body->axes;
  }
  if (const auto* compound = std::get_if<Compound>(&shape)) {
    return compound->body->axes;
  }
  return Quaternion::Identity();
}

Box bounding_box(const Shape& shape) {
  return std::visit(
      Match{[](const Sphere& sphere) { return Box{Vector3::Constant(sphere.radius)}; },
            [](const Box& box) { return box; },
            [](const HalfSpace&) -> Box {
              throw InputError("", 0, "bounds", "a half-space is unbounded and has no box");
            },
            [](const Capsule& capsule) {
              const double r = capsule.radius;
              return Box{{r, 0.5 * capsule.length + r, r}};
            },
            [](const Cylinder& c) {
              return Box{{c.radius, 0.5 * c.length, c.radius}};
            },
            [](const Cone& cone) {
              return Box{{cone.radius, 0.75 * cone.height, cone.radius}};
            },
            [](const Hull& hull) {
              Vector3 half = Vector3::Zero();
              for (const Vector3& x : hull.core->vertices) {
                half = half.cwiseMax(x.cwiseAbs());
              }
              return Box{half + Vector3::Constant(hull.rounding)};
            },
            [](const Mesh& mesh) { return Box{mesh.body->half_extents}; },
            [](const Compound& compound) { return Box{compound.body->half_extents}; }},
      shape);
}

Vector3 half_space_normal(const HalfSpace& half_space, const Pose& pose) {
  return pose.orientation * half_space.normal_B;
}

}  // namespace core
}  // namespace kairos
