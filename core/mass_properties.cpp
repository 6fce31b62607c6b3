#include "core/mass_properties.hpp"

#include "core/error.hpp"
#include "core/exponential.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

[[noreturn]] void refuse(const std::string& reason) { throw InputError("", 0, "mesh", reason); }

void check_corners(std::span<const Vector3> vertices, std::span<const Triangle> triangles) {
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    if (!vertices[k].allFinite()) {
      refuse(fmt::format("vertex {} is not finite", k));
    }
  }
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    for (const std::size_t corner : triangles[k]) {
      if (corner >= vertices.size()) {
        refuse(fmt::format("triangle {} has the corner {}; allowed: 0 to {}", k, corner,
                           vertices.size() - 1));
      }
    }
  }
}

/// Refuses a surface that is not closed, or not oriented alike everywhere: each edge must be walked
/// once in each direction.
void check_closed(std::span<const Triangle> triangles) {
  using Edge = std::pair<std::size_t, std::size_t>;
  std::vector<Edge> there, back;
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      there.emplace_back(t[i], t[(i + 1) % 3]);
      back.emplace_back(t[(i + 1) % 3], t[i]);
    }
  }
  std::sort(there.begin(), there.end());
  std::sort(back.begin(), back.end());
  const auto twice = std::adjacent_find(there.begin(), there.end());
  if (twice != there.end()) {
    refuse(fmt::format("has the edge from {} to {} twice in the same direction", twice->first,
                       twice->second));
  }
  const auto differ = std::mismatch(there.begin(), there.end(), back.begin());
  if (differ.first != there.end()) {
    const Edge edge = std::min(*differ.first, *differ.second);
    refuse(fmt::format("is not closed: the edge between {} and {} has a triangle on one side only",
                       edge.first, edge.second));
  }
}

/// Integrals over the solid: 1, x, x x^T.
struct Integrals {
  double volume = 0.0;
  Vector3 first = Vector3::Zero();
  Matrix3 second = Matrix3::Zero();
};

Integrals integrate(std::span<const Vector3> vertices, std::span<const Triangle> triangles,
                    const Vector3& origin) {
  Integrals sum;
  for (const Triangle& t : triangles) {
    const Vector3 a = vertices[t[0]] - origin, b = vertices[t[1]] - origin,
                  c = vertices[t[2]] - origin;
    const double six_volumes = a.dot(b.cross(c));
    const Vector3 s = a + b + c;
    sum.volume += six_volumes / 6.0;
    sum.first += six_volumes / 24.0 * s;
    sum.second += six_volumes / 120.0 *
                  (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  return sum;
}

void choose_axes(MassProperties& solid) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(solid.inertia);
  solid.moments = solver.eigenvalues();
  Matrix3 axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) {
    axes.col(2) = -axes.col(2);
  }
  solid.axes = Quaternion(axes).normalized();
}

}  // namespace

MassProperties mass_properties(std::span<const Vector3> vertices,
                               std::span<const Triangle> triangles) {
  if (vertices.empty() || triangles.empty()) {
    refuse("is empty");
  }
  check_corners(vertices, triangles);
  check_closed(triangles);
  Vector3 middle = Vector3::Zero();
  double extent = 0.0;
  for (const Vector3& vertex : vertices) {
    middle += vertex / static_cast<double>(vertices.size());
  }
  for (const Vector3& vertex : vertices) {
    extent = std::max(extent, (vertex - middle).norm());
  }
  const Integrals rough = integrate(vertices, triangles, middle);
  // Rounding error of a sum of so many signed volumes, relative to the cube of the extent.
  const double roundoff =
      64.0 * std::numeric_limits<double>::epsilon() * static_cast<double>(triangles.size());
  if (!(std::abs(rough.volume) > roundoff * power(extent, 3))) {
    refuse("encloses no volume");
  }
  if (rough.volume < 0.0) {
    refuse("is turned inside out: corners must go counterclockwise seen from outside");
  }
  MassProperties solid;
  solid.centre = middle + rough.first / rough.volume;
  const Integrals about_centre = integrate(vertices, triangles, solid.centre);
  solid.volume = about_centre.volume;
  solid.inertia = about_centre.second.trace() * Matrix3::Identity() - about_centre.second;
  choose_axes(solid);
  // No mass distribution has a moment larger than the sum of the other two.
  const double excess = 2.0 * solid.moments.maxCoeff() - solid.moments.sum();
  if (!(solid.moments.minCoeff() > 0.0) || excess > roundoff * power(extent, 5)) {
    refuse("crosses itself: its moments of inertia are those of no solid");
  }
  return solid;
}

bool is_principal(const Matrix3& inertia) {
  constexpr double tolerance = 1e-12;
  const double across =
      std::max({std::abs(inertia(0, 1)), std::abs(inertia(0, 2)), std::abs(inertia(1, 2))});
  return across <= tolerance * inertia.trace();
}

}  // namespace core
}  // namespace kairos
