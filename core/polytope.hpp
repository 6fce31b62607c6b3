#pragma once

#include "core/mesh_data.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace kairos {
inline namespace core {

/// Rows of different lengths in one array: row i is `items[start[i]]` to `items[start[i + 1]]`.
struct IndexRows {
  std::vector<std::uint32_t> start{0};
  std::vector<std::uint32_t> items;

  /// Row i < `size()`.
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t i) const {
    return std::span(items).subspan(start[i], start[i + 1] - start[i]);
  }
  /// How many rows there are.
  [[nodiscard]] std::size_t size() const { return start.size() - 1; }
  /// Appends a row.
  void add(std::span<const std::uint32_t> row) {
    items.insert(items.end(), row.begin(), row.end());
    start.push_back(static_cast<std::uint32_t>(items.size()));
  }
};

/// A convex polytope, its origin the centroid. It *is* the hull of its vertices as they are stored;
/// faces, normals and edges are those tables from which directions are proposed.
struct Polytope {
  std::vector<Vector3> vertices;  ///< m
  IndexRows faces;                ///< corners of each, counterclockwise seen from outside
  std::vector<Vector3> normals;   ///< of the faces, outward, unit
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<Vector3> directions;  ///< of the edges, unit
  IndexRows faces_at;               ///< a vertex
  IndexRows edges_at;               ///< a vertex
  double radius = 0.0;              ///< of the ball about the origin that contains it, m
  double extent = 0.0;              ///< greatest sum of the magnitudes of a vertex' coordinates, m
  double width = 0.0;               ///< least extent along the normal of a face, m
  double volume = 0.0;              ///< m^3
  Vector3 moments = Vector3::Zero();         ///< principal, of inertia for density 1, kg m^2
  Quaternion axes = Quaternion::Identity();  ///< the principal axes, in those of the vertices
};

/// The convex hull of points, and where it was: a point x of the polytope was centre + x.
struct ConvexHull {
  std::shared_ptr<const Polytope> polytope;
  Vector3 centre = Vector3::Zero();  ///< its centroid, frame of the points, m
};

/// The hull of points, every decision exact (which vertices, which of them lie in one face). Axes
/// that are principal to roundoff are told as such. Throws `std::invalid_argument` where there is
/// none with a volume: fewer than four points, a point, a line, a plane; numbers not finite.
[[nodiscard]] ConvexHull convex_hull(std::span<const Vector3> points);
/// The same where the points are told: vertices are the points bit for bit, about their origin. The
/// moments are those about the centroid.
[[nodiscard]] std::shared_ptr<const Polytope> hull_in_place(std::span<const Vector3> points);
/// Radius, extent and width from vertices (and normals; without any the width is the least extent
/// along the axes).
void add_sizes(Polytope& polytope);

/// On which side of the plane through a, b, c (counterclockwise seen from outside) is d: 1 outside,
/// -1 inside, 0 exactly on it? Exact, unless differences of coordinates over- or underflow.
[[nodiscard]] int side_of_plane(const Vector3& a, const Vector3& b, const Vector3& c,
                                const Vector3& d);

}  // namespace core
}  // namespace kairos
