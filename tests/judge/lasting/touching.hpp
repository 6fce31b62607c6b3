#pragma once

#include "core/shape.hpp"
#include "tests/judge/lasting/moment.hpp"

#include <vector>

namespace kairos::judge {

/// A point where two bodies touch or nearly do.
struct TouchPoint {
  Vector at;      ///< in the middle between the surfaces, m
  Vector normal;  ///< unit, from the first body to the second
};

/// How two bodies lie to each other.
struct Nearness {
  Real gap = 0;  ///< m; < 0: so deep one is in the other; of boxes the greatest of fifteen axes
  std::vector<TouchPoint> points;  ///< where surfaces are no farther apart than asked
};

/// Whether the judge knows the shape: spheres, boxes, half-spaces.
[[nodiscard]] bool known(const Shape& shape);

/// By closed forms: nearest points of balls, corners over planes, and of two boxes the features
/// that are extreme along each axis that separates them, cut with each other. `margin`: how far
/// apart what touches may be, m.
[[nodiscard]] Nearness nearness(const Shape& a, const Moment& at_a, const Shape& b,
                                const Moment& at_b, Real margin);

/// How far a body reaches from its origin, m; 0 of a half-space.
[[nodiscard]] Real reach(const Shape& shape);

}  // namespace kairos::judge
