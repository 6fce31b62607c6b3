#pragma once

#include "ccd/mesh/mesh_pair.hpp"

namespace kairos::ccd {

/// Between which numbers the distance of two triangles is, with points of both that are at most
/// `upper` apart (exact to rounding, which `upper` includes).
struct TriangleDistance {
  double lower = 0.0;  ///< 0 where nothing is proven: they may touch
  double upper = 0.0;
  Vector3 on_a = Vector3::Zero(), on_b = Vector3::Zero();
};

/// From below by directions along which they are apart: that of the nearest points, and where it is
/// noise, normals and products of edges; from above by points of both, the nearest ones of their
/// edges, and of corners and faces [Ericson2005, 5.1]. Each coordinate is off by at most `error`.
/// Triangles that cross each other have `lower` 0 and an `upper` that says nothing.
[[nodiscard]] TriangleDistance triangle_distance(const Corners& a, const Corners& b, double error);

/// A point of both, nearly: of triangles that touch.
[[nodiscard]] Vector3 common_point(const Corners& a, const Corners& b);

/// Less than their distance, at a tenth of the cost: by the axes of the frame and both normals; 0
/// or less where these prove nothing.
[[nodiscard]] double quick_triangle_distance(const Corners& a, const Corners& b, double error);

}  // namespace kairos::ccd
