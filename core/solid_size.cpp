#include "core/solid_size.hpp"

#include "core/circular.hpp"
#include "core/compound_body.hpp"
#include "core/exponential.hpp"
#include "core/mesh_body.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kairos {
inline namespace core {
namespace {

constexpr double pi = std::numbers::pi;

template <typename... Cases>
struct Match : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
Match(Cases...) -> Match<Cases...>;

double area_of_faces(const Polytope& polytope) {
  double area = 0.0;
  for (std::size_t f = 0; f < polytope.faces.size(); ++f) {
    const auto corners = polytope.faces[f];
    const Vector3& first = polytope.vertices[corners[0]];
    for (std::size_t k = 2; k < corners.size(); ++k) {
      area += 0.5 * (polytope.vertices[corners[k - 1]] - first)
                        .cross(polytope.vertices[corners[k]] - first)
                        .norm();
    }
  }
  return area;
}

/// Half the sum of the edges' lengths times the angles by which the normals of their faces differ:
/// the mean curvature of the surface, m.
double mean_curvature(const Polytope& polytope) {
  double sum = 0.0;
  for (const auto& [from, to] : polytope.edges) {
    const auto at = polytope.faces_at[from];
    const auto other = polytope.faces_at[to];
    Vector3 normals[2];
    int found = 0;
    for (const std::uint32_t f : at) {
      if (found < 2 && std::find(other.begin(), other.end(), f) != other.end()) {
        normals[found++] = polytope.normals[f];
      }
    }
    if (found == 2) {
      const double angle =
          arc_tangent(normals[0].cross(normals[1]).norm(), normals[0].dot(normals[1]));
      sum += 0.5 * angle * (polytope.vertices[to] - polytope.vertices[from]).norm();
    }
  }
  return sum;
}

std::shared_ptr<const Polytope> resized(const Polytope& polytope, double size) {
  auto larger = std::make_shared<Polytope>(polytope);
  for (Vector3& x : larger->vertices) {
    x *= size;
  }
  larger->radius *= size;
  larger->extent *= size;
  larger->width *= size;
  larger->volume *= power(size, 3);
  larger->moments *= power(size, 5);
  return larger;
}

}  // namespace

/// Of rounded bodies by Steiner's formula [Schneider2014, 4.2].
double solid_volume(const Shape& shape) {
  return std::visit(
      Match{[](const Sphere& s) { return 4.0 / 3.0 * pi * s.radius * s.radius * s.radius; },
            [](const Box& box) { return 8.0 * box.half_extents.prod(); },
            [](const HalfSpace&) { return 0.0; },
            [](const Capsule& c) {
              return pi * c.radius * c.radius * (c.length + 4.0 / 3.0 * c.radius);
            },
            [](const Cylinder& c) { return pi * c.radius * c.radius * c.length; },
            [](const Cone& c) { return pi / 3.0 * c.radius * c.radius * c.height; },
            [](const Hull& hull) {
              const double r = hull.rounding;
              return r == 0.0 ? hull.core->volume
                              : hull.core->volume + r * area_of_faces(*hull.core) +
                                    r * r * mean_curvature(*hull.core) + 4.0 / 3.0 * pi * r * r * r;
            },
            [](const Mesh& mesh) { return mesh.body->volume; },
            [](const Compound& compound) { return compound.body->volume; }},
      shape);
}

double surface_area(const Shape& shape) {
  return std::visit(
      Match{
          [](const Sphere& s) { return 4.0 * pi * s.radius * s.radius; },
          [](const Box& box) {
            const Vector3& h = box.half_extents;
            return 8.0 * (h.x() * h.y() + h.y() * h.z() + h.z() * h.x());
          },
          [](const HalfSpace&) { return 0.0; },
          [](const Capsule& c) { return 2.0 * pi * c.radius * (c.length + 2.0 * c.radius); },
          [](const Cylinder& c) { return 2.0 * pi * c.radius * (c.length + c.radius); },
          [](const Cone& c) { return pi * c.radius * (c.radius + hypotenuse(c.radius, c.height)); },
          [](const Hull& hull) {
            const double r = hull.rounding;
            const double faces = area_of_faces(*hull.core);
            return r == 0.0 ? faces
                            : faces + 2.0 * r * mean_curvature(*hull.core) + 4.0 * pi * r * r;
          },
          [](const Mesh& mesh) { return mesh.body->area; },
          [](const Compound& compound) {
            double area = 0.0;
            for (const CompoundPart& part : compound.body->parts) {
              area += surface_area(part.shape);
            }
            return area;
          }},
      shape);
}

Shape resized(const Shape& shape, double size) {
  return std::visit(
      Match{[size](const Sphere& s) -> Shape { return Sphere{s.radius * size}; },
            [size](const Box& box) -> Shape { return Box{box.half_extents * size}; },
            [](const HalfSpace& half_space) -> Shape { return half_space; },
            [size](const Capsule& c) -> Shape {
              return Capsule{c.radius * size, c.length * size};
            },
            [size](const Cylinder& c) -> Shape {
              return Cylinder{c.radius * size, c.length * size};
            },
            [size](const Cone& c) -> Shape {
              return Cone{c.radius * size, c.height * size};
            },
            [size](const Hull& hull) -> Shape {
              return size == 1.0 ? hull : Hull{resized(*hull.core, size), hull.rounding * size};
            },
            [size](const Mesh& mesh) -> Shape {
              return size == 1.0 ? mesh : Mesh{resized(*mesh.body, size)};
            },
            [size](const Compound& compound) -> Shape {
              return size == 1.0 ? compound : Compound{resized(*compound.body, size)};
            }},
      shape);
}

}  // namespace core
}  // namespace kairos
