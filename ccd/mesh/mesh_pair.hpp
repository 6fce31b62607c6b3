#pragma once

#include "ccd/linear/exact_integer.hpp"
#include "core/collision_mesh.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace kairos::ccd {

/// Three points: the corners of a triangle.
using Corners = std::array<Vector3, 3>;
using ExactPoint = std::array<ExactInteger, 3>;
using ExactCorners = std::array<ExactPoint, 3>;

/// Two meshes seen from the frame of the first one, in doubles with a bound on their error, and, on
/// request, exactly. What is exact: a vertex v of a mesh at pose (p, q) is the rational point
/// p + R(q) v / |q|^2 with all numbers as the doubles that they are.
class MeshPair {
 public:
  MeshPair(const PosedMesh& a, const PosedMesh& b);

  [[nodiscard]] const CollisionMesh& a() const { return a_.mesh; }
  [[nodiscard]] const CollisionMesh& b() const { return b_.mesh; }
  /// Whose frame this is.
  [[nodiscard]] const Pose& pose() const { return a_.pose; }

  /// A triangle of the first mesh: exact.
  [[nodiscard]] Corners corners_a(std::uint32_t triangle) const {
    return corners(a_.mesh, triangle);
  }
  /// A triangle of the second: coordinates are off by at most `error()`.
  [[nodiscard]] Corners corners_b(std::uint32_t triangle) const {
    Corners t = corners(b_.mesh, triangle);
    for (Vector3& v : t) {
      v = seen(v);
    }
    return t;
  }
  /// A point of the frame of b, in that of a.
  [[nodiscard]] Vector3 seen(const Vector3& v_B) const { return turn_ * v_B + shift_; }
  /// A box of the second mesh: its centre is off by at most `error()`, entries of its axes by 64 u.
  [[nodiscard]] ObbBox box_b(const ObbNode& node) const {
    const ObbBox box = box_of(node);
    return {turn_ * box.axes, seen(box.centre), box.half_extents};
  }
  /// Of a coordinate of a vertex or centre of b, as seen from a, m.
  [[nodiscard]] double error() const { return error_; }

  /// Two triangles in whole numbers of one common unit.
  void exact_corners(std::uint32_t triangle_a, std::uint32_t triangle_b, ExactCorners& a,
                     ExactCorners& b) const;
  /// Points of the frames of a (exact doubles) and of b, in whole numbers of one common unit.
  void exact_points(std::span<const Vector3> of_a, std::span<const Vector3> of_b,
                    std::span<ExactPoint> a, std::span<ExactPoint> b) const;

 private:
  static Corners corners(const CollisionMesh& mesh, std::uint32_t triangle) {
    const Triangle& t = mesh.triangles()[triangle];
    return {mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]]};
  }

  PosedMesh a_, b_;
  Matrix3 turn_;   ///< R_AB
  Vector3 shift_;  ///< p_AB
  double error_;
};

}  // namespace kairos::ccd
