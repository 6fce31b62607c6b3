#pragma once

#include "core/contact_detector.hpp"

namespace kairos::ccd {

/// Extents are at least, and coordinates and extents at most so large, m: fourth powers of them and
/// of what separates them stay within the range of a double.
inline constexpr double least_extent = 1e-70;
inline constexpr double greatest_size = 1e70;
/// How far from 1 the length of an orientation may be: what a person's rounding may cost.
inline constexpr double unit_tolerance = 1e-6;

/// What a detector can answer, checked before it does: an answer to nonsense would look like any
/// other. All throw `std::invalid_argument` with a message that names what is wrong and what is
/// allowed:
/// - extents from `least_extent` up to `greatest_size`;
/// - normals of length 1 to roundoff, orientations of length 1 within 1e-6 (a quaternion polynomial
///   may have any but 0), error radii >= 0;
/// - a window that both motions last through, but for the rounding of times (1e-12 of them), of a
///   duration >= 0; a tolerance >= 0.
void check_query(const MovingShape& a, const MovingShape& b, const Window& window,
                 double tolerance);
/// Are the coordinates of both, and what they turn by, known and at most `greatest_size` all
/// through the window? A motion that an integration lost (huge, infinite, NaN) is no error of who
/// asks, and nothing can be proven of it: the answer is `undecided`.
[[nodiscard]] bool within_range(const MovingShape& a, const MovingShape& b, const Window& window);
/// The checks of extents, normals and orientations, for shapes at poses.
void check_poses(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);

}  // namespace kairos::ccd
