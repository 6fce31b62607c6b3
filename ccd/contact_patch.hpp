#pragma once

#include "ccd/relative_boxes.hpp"

#include <array>

namespace kairos::ccd {

/// Where two boxes touch along an axis, in the frame of a: nearest (deepest) points of both.
struct ContactPatch {
  Vector3 on_a = Vector3::Zero();
  Vector3 on_b = Vector3::Zero();
};

/// Centroid of the contact patch. A face axis: the face of the other box that looks most against it
/// is clipped by the side planes of the reference face [Ericson2005, sec. 8.3.4], and of what is
/// left the lowest part within roundoff counts, so that boxes that meet flat meet in the middle of
/// the common area, and a tilted one at its edge or corner. An edge axis: the nearest points of the
/// two edges.
[[nodiscard]] ContactPatch contact_patch(const RelativeBoxes& boxes, const AxisSeparation& axis);
/// The same for an axis, its sign, and the direction found along it (unit, frame of a): the cross
/// product of nearly parallel edges would come out otherwise when it is computed again.
[[nodiscard]] ContactPatch contact_patch(const RelativeBoxes& boxes, int axis, double sign,
                                         const Vector3& n_A);

/// All corners of the patch along an axis, however high above the reference face: pairs of points
/// with the same coordinates along it. None where the faces lie beside each other.
struct PatchCorners {
  int size = 0;
  std::array<ContactPatch, 12> points{};
};
/// Corners of the patch along an axis of these boxes.
[[nodiscard]] PatchCorners patch_corners(const RelativeBoxes& boxes, const AxisSeparation& axis);

/// Centroid of the lowest vertices, within roundoff, of a box along a direction: the point where it
/// touches a plane with that normal. `down`: unit, towards the plane, in the frame of the box.
[[nodiscard]] Vector3 lowest_centroid(const Vector3& half, const Vector3& down, double roundoff);

}  // namespace kairos::ccd
