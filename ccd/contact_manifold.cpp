#include "ccd/contact_manifold.hpp"

#include "ccd/contact_patch.hpp"
#include "ccd/core_of_shape.hpp"
#include "ccd/nearest_points.hpp"
#include "ccd/pair_overlap.hpp"
#include "ccd/parts_at_rest.hpp"
#include "ccd/placed_cores.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

/// Parallel to an axis of the box, to roundoff.
bool is_face_normal(const Vector3& n_B) { return n_B.cwiseAbs().maxCoeff() >= 1.0 - 1e-12; }

/// A ball against anything: the point of `measure_overlap`.
ContactManifold ball_manifold(const Shape& a, const Pose& pose_a, const Shape& b,
                              const Pose& pose_b, double reach) {
  const Overlap o = measure_overlap(a, pose_a, b, pose_b);
  ContactManifold manifold;
  manifold.normal = o.normal;
  if (o.gap <= reach) {
    manifold.add(o.point, o.gap);
  }
  manifold.face_of_b =
      std::holds_alternative<HalfSpace>(b) ||
      (std::holds_alternative<Box>(b) && is_face_normal(pose_b.orientation.conjugate() * o.normal));
  return manifold;
}

ContactManifold box_on_plane(const Box& box, const Pose& pose_b, const HalfSpace& half_space,
                             const Pose& pose_h, double reach) {
  const Vector3 up = half_space_normal(half_space, pose_h);
  ContactManifold manifold;
  manifold.normal = -up;
  manifold.face_of_b = true;
  manifold.face_of_a = is_face_normal(pose_b.orientation.conjugate() * up);
  const Vector3 up_B = pose_b.orientation.conjugate() * up;
  const double height = up.dot(pose_b.position - pose_h.position);
  for (int k = 0; k < 8; ++k) {
    const Vector3 corner = box_corner(box.half_extents, k);
    const double gap = height + up_B.dot(corner);
    if (gap <= reach) {
      manifold.add(pose_b.to_world(corner) - up * (0.5 * gap), gap);
    }
  }
  return manifold;
}

/// The axis of a patch: that of greatest separation, but the normal of a face rather than of two
/// edges where it separates nearly as well, within a twentieth of the depth and 1e-4 of the smaller
/// box. Boxes that lie on each other with a small tilt touch in a face: one point where two edges
/// cross would let them topple.
AxisSeparation patch_axis(const RelativeBoxes& s) {
  const AxisSeparation axis = greatest_separation(s);
  if (axis.axis < 6) {
    return axis;
  }
  AxisSeparation face = axis_separation(s, 0);
  for (int k = 1; k < 6; ++k) {
    const AxisSeparation other = axis_separation(s, k);
    face = other.gap() > face.gap() ? other : face;
  }
  const double size = std::min(s.half_a.minCoeff(), s.half_b.minCoeff());
  const double nearly = 0.05 * std::abs(axis.gap()) + 1e-4 * size;
  return face.gap() >= axis.gap() - nearly ? face : axis;
}

/// Points in the frame of a, to the world.
ContactManifold box_on_box(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b,
                           double reach) {
  const RelativeBoxes s(a, pose_a, b, pose_b);
  const AxisSeparation axis = patch_axis(s);
  ContactManifold manifold;
  const Vector3 n_A = axis_normal(s, axis);
  manifold.normal = pose_a.orientation * n_A;
  if (axis.gap() > reach) {
    return manifold;
  }
  manifold.face_of_a = axis.axis < 3 || is_face_normal(n_A);
  manifold.face_of_b =
      (axis.axis >= 3 && axis.axis < 6) || is_face_normal(s.axes_A.transpose() * n_A);
  const PatchCorners corners = patch_corners(s, axis);
  for (int k = 0; k < corners.size; ++k) {
    const auto [on_a, on_b] = corners.points[static_cast<std::size_t>(k)];
    const double gap = n_A.dot(on_b - on_a);
    if (gap <= reach) {
      manifold.add(pose_a.to_world(0.5 * (on_a + on_b)), gap);
    }
  }
  return manifold;
}

ContactManifold turned_round(ContactManifold manifold) {
  manifold.normal = -manifold.normal;
  std::swap(manifold.face_of_a, manifold.face_of_b);
  return manifold;
}

}  // namespace

ContactManifold contact_manifold(const Shape& a, const Pose& pose_a, const Shape& b,
                                 const Pose& pose_b, double reach) {
  if (shape_rank(a) > shape_rank(b)) {
    return turned_round(contact_manifold(b, pose_b, a, pose_a, reach));
  }
  if (has_parts(a) || has_parts(b)) {
    return parts_manifold(a, pose_a, b, pose_b, reach);
  }
  if (is_convex_pair(a, b)) {
    return core_manifold(a, pose_a, b, pose_b, reach);
  }
  if (std::holds_alternative<Sphere>(a)) {
    return ball_manifold(a, pose_a, b, pose_b, reach);
  }
  if (const auto* box = std::get_if<Box>(&a)) {
    if (const auto* other = std::get_if<Box>(&b)) {
      return box_on_box(*box, pose_a, *other, pose_b, reach);
    }
    return box_on_plane(*box, pose_a, std::get<HalfSpace>(b), pose_b, reach);
  }
  return {};
}

}  // namespace kairos::ccd
