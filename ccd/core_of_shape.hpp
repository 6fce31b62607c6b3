#pragma once

#include "ccd/convex_core.hpp"
#include "core/shape.hpp"

namespace kairos::ccd {

/// The core of a shape, its rounding included; it refers to the shape's polytope. A half-space has
/// none: throws `std::invalid_argument`.
[[nodiscard]] ConvexCore core_of(const Shape& shape);
/// The same; of a mesh or a compound the box around it.
[[nodiscard]] ConvexCore core_around(const Shape& shape);
/// Are they asked for as cores? Boxes and spheres among themselves have formulas of their own.
[[nodiscard]] bool is_convex_pair(const Shape& a, const Shape& b);
/// Is it a capsule, a cylinder, a cone, a hull, a mesh or a compound?
[[nodiscard]] bool needs_core(const Shape& shape);

}  // namespace kairos::ccd
