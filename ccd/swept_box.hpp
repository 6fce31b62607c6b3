#pragma once

#include "ccd/oriented_box.hpp"
#include "core/broad_phase.hpp"
#include "core/contact_detector.hpp"

namespace kairos::ccd {

/// How far a moving shape reaches along a fixed direction over [s0, s1] of its motion: an interval
/// that contains n . x for all its points x, rounding included. The translation is bounded by its
/// Bernstein coefficients, the turning extents by the cosines of the least angles that the axes can
/// make with n.
struct Reach {
  double lower = 0.0;  ///< m
  double upper = 0.0;  ///< m
};
/// `n`: unit, world frame; s0 <= s1, local time of the motion, s.
[[nodiscard]] Reach swept_reach(const Shape& shape, const Motion& motion, double s0, double s1,
                                const Vector3& n);

/// The box, with these axes, that contains a shape during [s0, s1] of its motion.
[[nodiscard]] OrientedBox swept_box(const Shape& shape, const Motion& motion, double s0, double s1,
                                    const Matrix3& axes);
/// The thesis' construction (fig. 14): one box around both end positions, aligned with the
/// displacement (with the body's own axes where there is none), and around all that is between.
[[nodiscard]] OrientedBox swept_box(const Shape& shape, const Motion& motion, double s0, double s1);

/// Axis-aligned box of a shape during [s0, s1] of its motion, for the broad phase. A half-space
/// fills everything it can reach: unbounded sides are infinite.
[[nodiscard]] Aabb swept_aabb(const Shape& shape, const Motion& motion, double s0, double s1);

/// Do the swept boxes (fig. 14) of two shapes over a window overlap? "No" is proven. Shapes in the
/// order sphere, box, half-space.
[[nodiscard]] bool swept_shapes_overlap(const MovingShape& a, const MovingShape& b,
                                        const Window& window);

}  // namespace kairos::ccd
