#include "ccd/pair_overlap.hpp"

#include "ccd/contact_patch.hpp"
#include "ccd/core_of_shape.hpp"
#include "ccd/nearest_points.hpp"
#include "ccd/parts_at_rest.hpp"
#include "ccd/placed_cores.hpp"
#include "ccd/rounding/roundoff.hpp"

#include <cmath>

namespace kairos::ccd {
namespace {

bool balls_overlap(const Vector3& p_a, const Vector3& p_b, double reach) {
  return (p_b - p_a).squaredNorm() <= reach * reach;
}

bool overlap(const Sphere& a, const Pose& pose_a, const Sphere& b, const Pose& pose_b) {
  return balls_overlap(pose_a.position, pose_b.position, a.radius + b.radius);
}

bool overlap(const Sphere& sphere, const Pose& pose_s, const Box& box, const Pose& pose_b) {
  const Vector3 c = pose_b.to_body(pose_s.position);
  const Vector3 outside = (c.cwiseAbs() - box.half_extents).cwiseMax(0.0);
  return outside.squaredNorm() <= sphere.radius * sphere.radius;
}

bool overlap(const Sphere& sphere, const Pose& pose_s, const HalfSpace& half_space,
             const Pose& pose_h) {
  return half_space_normal(half_space, pose_h).dot(pose_s.position - pose_h.position) <=
         sphere.radius;
}

bool overlap(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b) {
  return boxes_overlap(RelativeBoxes(a, pose_a, b, pose_b));
}

/// Half the extent of a box along a unit direction given in the world.
double support(const Box& box, const Vector3& n_B) { return box.half_extents.dot(n_B.cwiseAbs()); }

bool overlap(const Box& box, const Pose& pose_b, const HalfSpace& half_space, const Pose& pose_h) {
  const Vector3 n = half_space_normal(half_space, pose_h);
  return n.dot(pose_b.position - pose_h.position) <=
         support(box, pose_b.orientation.conjugate() * n);
}

Overlap measure(const Sphere& a, const Pose& pose_a, const Sphere& b, const Pose& pose_b) {
  return measure_overlap_of_balls(pose_a.position, a.radius, pose_b.position, b.radius);
}

Overlap measure(const Sphere& sphere, const Pose& pose_s, const Box& box, const Pose& pose_b) {
  const Vector3 c = pose_b.to_body(pose_s.position);
  const Vector3 nearest = c.cwiseMax(-box.half_extents).cwiseMin(box.half_extents);
  const Vector3 out = c - nearest;
  const double distance = out.norm();
  Overlap answer;
  answer.overlapping = overlap(sphere, pose_s, box, pose_b);
  Vector3 n_B;
  Vector3 on_box = nearest;
  if (distance > 0.0) {
    n_B = -out / distance;
    answer.gap = distance - sphere.radius;
  } else {  // the centre is inside: the nearest face is the way out
    int face = 0;
    const Vector3 depth = box.half_extents - c.cwiseAbs();
    depth.minCoeff(&face);
    const double side = c[face] < 0.0 ? -1.0 : 1.0;
    n_B = -side * Vector3::Unit(face);
    on_box[face] = side * box.half_extents[face];
    answer.gap = -depth[face] - sphere.radius;
  }
  answer.normal = pose_b.orientation * n_B;
  answer.point = pose_b.to_world(on_box) - answer.normal * (0.5 * answer.gap);
  return answer;
}

/// From a half-space to a body above it: normal up, hence turned round for (body, half-space).
Overlap above_plane(double gap, const Vector3& up, const Vector3& lowest) {
  return {gap <= 0.0, gap, -up, lowest - up * (0.5 * gap)};
}

Overlap measure(const Sphere& sphere, const Pose& pose_s, const HalfSpace& half_space,
                const Pose& pose_h) {
  const Vector3 n = half_space_normal(half_space, pose_h);
  const double gap = n.dot(pose_s.position - pose_h.position) - sphere.radius;
  return above_plane(gap, n, pose_s.position - n * sphere.radius);
}

Overlap measure(const Box& box, const Pose& pose_b, const HalfSpace& half_space,
                const Pose& pose_h) {
  const Vector3 n = half_space_normal(half_space, pose_h);
  const Vector3 down_B = -(pose_b.orientation.conjugate() * n);
  const double gap = n.dot(pose_b.position - pose_h.position) - support(box, down_B);
  // Roundoff of a rotated extent: 1024 u of the size, as for clipped faces.
  const Vector3 lowest =
      lowest_centroid(box.half_extents, down_B, 1024.0 * unit_roundoff * box.half_extents.sum());
  return above_plane(gap, n, pose_b.to_world(lowest));
}

Overlap measure(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b) {
  const RelativeBoxes s(a, pose_a, b, pose_b);
  const AxisSeparation axis = sharpened(s, greatest_separation(s));
  Overlap answer;
  answer.overlapping = boxes_overlap(s);
  answer.gap = axis.gap();
  Vector3 n_A = axis_normal(s, axis);
  ContactPatch patch = contact_patch(s, axis);
  // Apart, the axis gives the distance only between a face and what is above it, or two edges;
  // where corners are nearest, it is the distance of the corners.
  if (answer.gap > 64.0 * s.error()) {
    const double patch_gap = (patch.on_b - patch.on_a).norm();
    if (patch_gap > answer.gap * (1.0 + 1e-9)) {
      const NearestPoints nearest = nearest_of_boxes(s);
      if (nearest.distance > answer.gap + 64.0 * s.error()) {
        n_A = (nearest.on_b - nearest.on_a) / nearest.distance;
        patch = {nearest.on_a, nearest.on_b};
      }
      answer.gap = std::max(answer.gap, nearest.distance);
    }
  }
  answer.normal = pose_a.orientation * n_A;
  answer.point = pose_a.to_world(0.5 * (patch.on_a + patch.on_b));
  return answer;
}

Overlap turned_round(Overlap answer) {
  answer.normal = -answer.normal;
  return answer;
}

}  // namespace

bool shapes_overlap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  if (shape_rank(a) > shape_rank(b)) {
    return shapes_overlap(b, pose_b, a, pose_a);
  }
  if (has_parts(a) || has_parts(b)) {
    return parts_overlap(a, pose_a, b, pose_b);
  }
  if (is_convex_pair(a, b)) {
    return cores_overlap(a, pose_a, b, pose_b);
  }
  if (const auto* sphere = std::get_if<Sphere>(&a)) {
    if (const auto* other = std::get_if<Sphere>(&b)) {
      return overlap(*sphere, pose_a, *other, pose_b);
    }
    if (const auto* box = std::get_if<Box>(&b)) {
      return overlap(*sphere, pose_a, *box, pose_b);
    }
    return overlap(*sphere, pose_a, std::get<HalfSpace>(b), pose_b);
  }
  if (const auto* box = std::get_if<Box>(&a)) {
    if (const auto* other = std::get_if<Box>(&b)) {
      return overlap(*box, pose_a, *other, pose_b);
    }
    return overlap(*box, pose_a, std::get<HalfSpace>(b), pose_b);
  }
  return false;
}

Overlap measure_overlap_of_balls(const Vector3& p_a, double radius_a, const Vector3& p_b,
                                 double radius_b) {
  const Vector3 d = p_b - p_a;
  const double distance = d.norm();
  const double gap = distance - (radius_a + radius_b);
  const Vector3 n = distance > 0.0 ? Vector3(d / distance) : Vector3(Vector3::UnitY());
  const Vector3 point = p_a + n * (radius_a + 0.5 * gap);
  return {balls_overlap(p_a, p_b, radius_a + radius_b), gap, n, point};
}

Overlap measure_overlap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  if (shape_rank(a) > shape_rank(b)) {
    return turned_round(measure_overlap(b, pose_b, a, pose_a));
  }
  if (has_parts(a) || has_parts(b)) {
    return measure_parts(a, pose_a, b, pose_b);
  }
  if (is_convex_pair(a, b)) {
    return measure_cores(a, pose_a, b, pose_b);
  }
  if (const auto* sphere = std::get_if<Sphere>(&a)) {
    if (const auto* other = std::get_if<Sphere>(&b)) {
      return measure(*sphere, pose_a, *other, pose_b);
    }
    if (const auto* box = std::get_if<Box>(&b)) {
      return measure(*sphere, pose_a, *box, pose_b);
    }
    return measure(*sphere, pose_a, std::get<HalfSpace>(b), pose_b);
  }
  if (const auto* box = std::get_if<Box>(&a)) {
    if (const auto* other = std::get_if<Box>(&b)) {
      return measure(*box, pose_a, *other, pose_b);
    }
    return measure(*box, pose_a, std::get<HalfSpace>(b), pose_b);
  }
  return {false, std::numeric_limits<double>::max(), Vector3::UnitY(), Vector3::Zero()};
}

}  // namespace kairos::ccd
