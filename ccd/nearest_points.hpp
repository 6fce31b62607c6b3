#pragma once

#include "ccd/relative_boxes.hpp"

namespace kairos::ccd {

/// Nearest points of two disjoint convex bodies, and their distance, m.
struct NearestPoints {
  Vector3 on_a = Vector3::Zero();
  Vector3 on_b = Vector3::Zero();
  double distance = 0.0;
};

/// Nearest points of two segments p + s u and q + t v with s in [-su, su], t in [-tv, tv] and unit
/// directions u, v [Ericson2005, sec. 5.1.9].
[[nodiscard]] NearestPoints nearest_of_segments(const Vector3& p, const Vector3& u, double su,
                                                const Vector3& q, const Vector3& v, double tv);

/// Nearest points of two disjoint boxes, in the frame of a: the least over the vertices of each
/// against the other box, and over the pairs of edges but those that are too far from the other
/// box. Exhaustive otherwise, so that no degenerate configuration is special.
[[nodiscard]] NearestPoints nearest_of_boxes(const RelativeBoxes& boxes);

/// Centre of edge of a box of these half extents: `direction` 0..2 along the edge, `corner` 0..3
/// choosing the signs of the other two coordinates.
[[nodiscard]] Vector3 edge_centre(const Vector3& half, int direction, int corner);
/// Corner 0..7 of a box of these half extents.
[[nodiscard]] Vector3 box_corner(const Vector3& half, int corner);

}  // namespace kairos::ccd
