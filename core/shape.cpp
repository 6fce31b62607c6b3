#include "core/shape.hpp"

#include "core/error.hpp"

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

}  // namespace

std::string_view shape_name(const Shape& shape) {
  return std::visit(Match{[](const Sphere&) -> std::string_view { return "sphere"; },
                          [](const Box&) -> std::string_view { return "box"; },
                          [](const HalfSpace&) -> std::string_view { return "half-space"; }},
                    shape);
}

double bounding_radius(const Shape& shape) {
  return std::visit(Match{[](const Sphere& sphere) { return sphere.radius; },
                          [](const Box& box) { return box.half_extents.norm(); },
                          [](const HalfSpace&) { return infinity; }},
                    shape);
}

double smallest_extent(const Shape& shape) {
  return std::visit(Match{[](const Sphere& sphere) { return 2.0 * sphere.radius; },
                          [](const Box& box) { return 2.0 * box.half_extents.minCoeff(); },
                          [](const HalfSpace&) { return infinity; }},
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
            [](const HalfSpace&) -> Vector3 { return Vector3::Zero(); }},
      shape);
}

Box bounding_box(const Shape& shape) {
  return std::visit(
      Match{[](const Sphere& sphere) { return Box{Vector3::Constant(sphere.radius)}; },
            [](const Box& box) { return box; },
            [](const HalfSpace&) -> Box {
              throw InputError("", 0, "bounds", "a half-space is unbounded and has no box");
            }},
      shape);
}

Vector3 half_space_normal(const HalfSpace& half_space, const Pose& pose) {
  return pose.orientation * half_space.normal_B;
}

}  // namespace core
}  // namespace kairos
