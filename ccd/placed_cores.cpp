#include "ccd/placed_cores.hpp"

#include "ccd/core_of_shape.hpp"
#include "ccd/core_patch.hpp"
#include "ccd/core_witness.hpp"
#include "ccd/rounding/rotation_matrix.hpp"
#include "ccd/rounding/roundoff.hpp"

#include <algorithm>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;
/// How near below the distance a separation is sought, as a part of it.
constexpr double precision = 1e-14;

/// Two shapes placed: cores, and what bounds the rounding of a separation.
struct Placed {
  Placed(const Shape& shape_a, const Pose& pose_a, const Shape& shape_b, const Pose& pose_b)
      : a(core_of(shape_a)),
        b(core_of(shape_b)),
        R_WA(rotation_matrix(pose_a.orientation)),
        R_WB(rotation_matrix(pose_b.orientation)),
        d(pose_b.position - pose_a.position),
        rounding(a.rounding() + b.rounding()),
        // Entries of both rotations are off by 8 u, a separation is a sum of products of them.
        error(24.0 * u * (d.lpNorm<1>() + 1.75 * (a.extent() + b.extent())) + 4.0 * u * rounding) {}
  Placed(const Placed&) = delete;
  Placed& operator=(const Placed&) = delete;

  [[nodiscard]] CorePair pair() const { return {a, b, R_WA, R_WB, d}; }
  [[nodiscard]] CoreWitness witness() const {
    return core_witness(pair(), rounding, precision, error);
  }

  ConvexCore a, b;
  Matrix3 R_WA, R_WB;
  Vector3 d;
  double rounding;
  double error;
};

struct OnPlane {
  OnPlane(const Shape& shape, const Pose& pose, const Shape& plane, const Pose& pose_h)
      : core(core_of(shape)),
        up(half_space_normal(std::get<HalfSpace>(plane), pose_h)),
        down_B(-(pose.orientation.conjugate() * up)),
        height(up.dot(pose.position - pose_h.position)) {}

  [[nodiscard]] double gap() const { return height - core.support(down_B) - core.rounding(); }

  ConvexCore core;
  Vector3 up;
  Vector3 down_B;
  double height;  ///< of the body's origin
};

bool on_plane(const Shape& b) { return std::holds_alternative<HalfSpace>(b); }

}  // namespace

bool cores_overlap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  if (on_plane(b)) {
    return OnPlane(a, pose_a, b, pose_b).gap() <= 0.0;
  }
  const Placed placed(a, pose_a, b, pose_b);
  // Balls around them that are apart need no search.
  const double reach = placed.rounding + placed.a.radius() + placed.b.radius();
  return placed.d.squaredNorm() <= reach * reach * (1.0 + 16.0 * u) &&
         placed.witness().separation <= placed.rounding;
}

Overlap measure_cores(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  if (on_plane(b)) {
    const OnPlane at(a, pose_a, b, pose_b);
    const double gap = at.gap();
    const Vector3 lowest = pose_a.to_world(lowest_point(at.core, at.down_B));
    return {gap <= 0.0, gap, -at.up, lowest - at.up * (at.core.rounding() + 0.5 * gap)};
  }
  const Placed placed(a, pose_a, b, pose_b);
  const CoreWitness witness = placed.witness();
  const double gap = witness.separation - placed.rounding;
  const Vector3 on_a = core_patch(placed.pair(), witness.n).on_a();
  return {gap <= 0.0, gap, witness.n,
          pose_a.position + on_a + witness.n * (placed.a.rounding() + 0.5 * gap)};
}

ContactManifold core_manifold(const Shape& a, const Pose& pose_a, const Shape& b,
                              const Pose& pose_b, double reach) {
  ContactManifold manifold;
  if (on_plane(b)) {
    const OnPlane at(a, pose_a, b, pose_b);
    manifold.normal = -at.up;
    manifold.face_of_b = true;
    const double lowest = at.gap();
    if (lowest > reach) {
      return manifold;
    }
    const FacePolygon face = highest_face(at.core, at.down_B, reach - lowest);
    manifold.face_of_a = highest_face(at.core, at.down_B, 0.0).size > 2;
    const int step = std::max(1, (face.size + 7) / 8);
    for (int i = 0; i < face.size; i += step) {
      const double gap = at.height - at.down_B.dot(face[i]) - at.core.rounding();
      manifold.add(pose_a.to_world(face[i]) - at.up * (at.core.rounding() + 0.5 * gap), gap);
    }
    return manifold;
  }
  const Placed placed(a, pose_a, b, pose_b);
  const CoreWitness witness = placed.witness();
  manifold.normal = witness.n;
  const double least = witness.separation - placed.rounding;
  if (least > reach) {
    return manifold;
  }
  const CorePatch patch = core_patch(placed.pair(), witness.n, reach - least);
  manifold.face_of_a = patch.face_of_a;
  manifold.face_of_b = patch.face_of_b;
  const int step = std::max(1, (patch.points.size + 7) / 8);
  for (int i = 0; i < patch.points.size; i += step) {
    const double gap = patch.gaps[static_cast<std::size_t>(i)] - placed.rounding;
    if (gap <= reach) {
      manifold.add(
          pose_a.position + patch.points[i] + witness.n * (placed.a.rounding() + 0.5 * gap), gap);
    }
  }
  return manifold;
}

DistanceBounds distance(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  const Placed placed(a, pose_a, b, pose_b);
  const CoreWitness witness = placed.witness();
  DistanceBounds bounds;
  const Vector3 n = witness.n;
  bounds.on_a = pose_a.position + witness.on_a + placed.a.rounding() * n;
  bounds.on_b = pose_a.position + witness.on_b - placed.b.rounding() * n;
  if (witness.depth > 0.0 || witness.upper + 2.0 * placed.error < placed.rounding) {
    return bounds;
  }
  bounds.lower = std::max(0.0, witness.separation - placed.error - placed.rounding);
  bounds.upper = std::max(0.0, witness.upper + 2.0 * placed.error - placed.rounding);
  return bounds;
}

DepthBounds depth(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  const Placed placed(a, pose_a, b, pose_b);
  const CoreWitness witness = placed.witness();
  DepthBounds bounds;
  bounds.normal = witness.n;
  bounds.upper = std::max(0.0, placed.rounding - witness.separation + placed.error);
  const double proven =
      witness.depth > 0.0 ? witness.depth - placed.error : -witness.upper - 2.0 * placed.error;
  bounds.lower = std::clamp(placed.rounding + proven, 0.0, bounds.upper);
  return bounds;
}

}  // namespace kairos::ccd
