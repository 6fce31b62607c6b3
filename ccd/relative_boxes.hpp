#pragma once

#include "ccd/oriented_box.hpp"
#include "core/shape.hpp"

#include <array>

namespace kairos::ccd {

/// Two boxes in the frame of the first: all that the separating-axis test needs.
struct RelativeBoxes {
  Vector3 half_a = Vector3::Zero();      ///< m
  Vector3 half_b = Vector3::Zero();      ///< m
  Vector3 d_A = Vector3::Zero();         ///< centre of b from the centre of a, frame of a, m
  Matrix3 axes_A = Matrix3::Identity();  ///< columns: axes of b in the frame of a (R_AB)

  RelativeBoxes() = default;
  /// Two boxes at poses in the world.
  RelativeBoxes(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b);
  /// Half extents (m) and axes (columns, world frame) of both; centre of b from that of a (world,
  /// m).
  RelativeBoxes(const Vector3& half_a_, const Matrix3& R_WA, const Vector3& half_b_,
                const Matrix3& R_WB, const Vector3& d_W);

  /// Bound of the rounding error of every (unnormalised) separation of these boxes, m: rotation
  /// entries are off by at most 8 u and every separation is a sum of at most 11 products.
  [[nodiscard]] double error() const;
};

/// The 15 candidate axes: 0..2 face normals of a, 3..5 of b, 6 + 3 i + j the cross product of edge
/// i of a and edge j of b (unnormalised) [Gottschalk1996].
inline constexpr int axis_count = 15;

/// Below this sine the separations of edges, whose error is that of a unit direction over the sine,
/// are evaluated again along unit directions.
inline constexpr double small_sine = 0.05;

/// Signed separation of the boxes along one axis and the axis itself.
struct AxisSeparation {
  int axis = 0;
  double value = 0.0;   ///< along the unnormalised axis, m (times its length)
  double length = 1.0;  ///< of the unnormalised axis: 1 for faces, the sine for edges
  double sign = 1.0;    ///< +1 if the axis points from a to b as it stands
  /// Along the unit axis, m; negative: they overlap along it.
  [[nodiscard]] double gap() const { return value / length; }
};

/// Separation along one axis, 0 <= `axis` < `axis_count`.
[[nodiscard]] AxisSeparation axis_separation(const RelativeBoxes& boxes, int axis);
/// Separation along an axis of two edges, 6 <= `axis` < `axis_count`, computed along the unit
/// direction: where edges are nearly parallel the rounding of `axis_separation` is divided by their
/// sine, and of this it is that of any separation. Minus infinity: they are parallel.
[[nodiscard]] AxisSeparation unit_edge_separation(const RelativeBoxes& boxes, int axis);
/// The axis of greatest separation. An edge pair competes with its separation lowered by the
/// rounding error before it is normalised: nearly parallel edges, whose cross product is noise,
/// can never win, and no angle has to be called "parallel".
[[nodiscard]] AxisSeparation greatest_separation(const RelativeBoxes& boxes);
/// The same of boxes that are given as in the constructor of `RelativeBoxes`.
[[nodiscard]] AxisSeparation greatest_separation(const Vector3& half_a, const Matrix3& R_WA,
                                                 const Vector3& half_b, const Matrix3& R_WB,
                                                 const Vector3& d_W);
/// The greatest separation where nearly parallel edges are asked as `unit_edge_separation` does:
/// known to the rounding error of any. `greatest`: as `greatest_separation` tells it, which stays
/// where no such edges can decide.
[[nodiscard]] AxisSeparation sharpened(const RelativeBoxes& boxes, const AxisSeparation& greatest);
/// Unit normal of an axis from a to b, in the frame of a.
[[nodiscard]] Vector3 axis_normal(const RelativeBoxes& boxes, const AxisSeparation& axis);

/// Do two boxes overlap (touching included)? Nothing is added to |R|; an edge pair separates only
/// beyond the rounding error, asked along the unit direction where the sine hides it.
[[nodiscard]] bool boxes_overlap(const RelativeBoxes& boxes);
/// Are they apart by more than the rounding error of any separation?
[[nodiscard]] bool boxes_apart(const RelativeBoxes& boxes);

/// What can be proven about an overlap.
enum class Verdict { separated, overlapping, undecided };
/// The same question proven: `separated` and `overlapping` hold for the real numbers that the
/// arguments are, `undecided` means that rounding could have decided.
[[nodiscard]] Verdict classify(const RelativeBoxes& boxes);
/// The same of boxes in the world.
[[nodiscard]] Verdict classify(const OrientedBox& a, const OrientedBox& b);
/// The same with coherence: `axis` is asked first, the one that separated these boxes when they
/// were last looked at (any at first); where others have to be asked it becomes one that separates
/// now.
[[nodiscard]] Verdict classify(const RelativeBoxes& boxes, int& axis);
/// The same of boxes that are given as in the constructor of `RelativeBoxes`.
[[nodiscard]] Verdict classify(const Vector3& half_a, const Matrix3& R_WA, const Vector3& half_b,
                               const Matrix3& R_WB, const Vector3& d_W);

/// Are all fifteen separations, edge pairs unnormalised, proven below -error (m)? `error` bounds
/// what the arguments themselves may be off by.
[[nodiscard]] bool all_separations_below(const Vector3& half_a, const Matrix3& R_WA,
                                         const Vector3& half_b, const Matrix3& R_WB,
                                         const Vector3& d_W, double error);

}  // namespace kairos::ccd
