#pragma once

#include "core/pose.hpp"

#include <array>
#include <cstddef>

namespace kairos {
inline namespace core {

/// Where two bodies touch, or nearly so: the points of one patch, on a plane with the common
/// normal. A ball has one point, an edge two, a face the corners of what both faces share.
struct ContactManifold {
  /// Of two faces of boxes: a quadrilateral clipped by four planes.
  static constexpr std::size_t most_points = 8;
  /// One point of the patch.
  struct Point {
    Vector3 position = Vector3::Zero();  ///< halfway between both surfaces, world frame, m
    double gap = 0.0;                    ///< along the normal, m; negative: penetration
  };

  Vector3 normal = Vector3::Zero();  ///< unit, from a to b, world frame
  std::size_t size = 0;              ///< 0: nothing is as near as was asked
  std::array<Point, most_points> points{};
  /// Whether the normal is that of a face of a, or of b: it then turns with that body, and points
  /// may slide along the face. Neither: two edges, a sphere's nearest point on an edge or a corner.
  bool face_of_a = false;
  bool face_of_b = false;

  /// Adds a point (world frame, m) and its signed gap (m), while there is room.
  void add(const Vector3& position, double gap) {
    if (size < most_points) {
      points[size++] = {position, gap};
    }
  }
};

}  // namespace core
}  // namespace kairos
