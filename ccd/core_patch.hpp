#pragma once

#include "ccd/core_pair.hpp"

#include <array>
#include <span>

namespace kairos::ccd {

/// A convex polygon in space: a point, an edge, or a face seen along a direction.
struct FacePolygon {
  static constexpr int most_points = 32;
  std::array<Vector3, most_points> points;
  int size = 0;

  [[nodiscard]] const Vector3& operator[](int i) const {
    return points[static_cast<std::size_t>(i)];
  }
  void add(const Vector3& x) {
    if (size < most_points) {
      points[static_cast<std::size_t>(size++)] = x;
    }
  }
  /// Of the area; of what has none, the middle.
  [[nodiscard]] Vector3 centroid() const;
};

/// The outline of points seen along the unit direction m, of at most 64; `size`: of what they are
/// on.
[[nodiscard]] FacePolygon outline_of(std::span<const Vector3> points, const Vector3& m,
                                     double size);
/// The points of a core that are at most `within` (m) below its highest along the unit direction m,
/// corners of their outline seen along it; of a circle sixteen. Body frame.
[[nodiscard]] FacePolygon highest_face(const ConvexCore& core, const Vector3& m, double within);
/// The middle of what is highest along m, to roundoff: where it touches a plane.
[[nodiscard]] Vector3 lowest_point(const ConvexCore& core, const Vector3& m);

/// What two cores have in common along n: of points on a, from its origin, world axes, the distance
/// to b along n (that of the cores, m).
struct CorePatch {
  FacePolygon points;
  std::array<double, FacePolygon::most_points> gaps{};
  bool face_of_a = false;  ///< n is across a face of a
  bool face_of_b = false;

  [[nodiscard]] Vector3 on_a() const { return points.centroid(); }
};
/// `within`: how much lower than the highest a point of a face may be, m; 0: roundoff.
[[nodiscard]] CorePatch core_patch(const CorePair& pair, const Vector3& n, double within = 0.0);

}  // namespace kairos::ccd
