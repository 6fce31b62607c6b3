#pragma once

#include "core/shape.hpp"

namespace kairos {
inline namespace core {

// Of the homogeneous solid that a shape is; a half-space has neither: 0.

[[nodiscard]] double solid_volume(const Shape& shape);  ///< m^3
[[nodiscard]] double surface_area(const Shape& shape);  ///< m^2

/// The same shape, `size` times as large.
[[nodiscard]] Shape resized(const Shape& shape, double size);

}  // namespace core
}  // namespace kairos
