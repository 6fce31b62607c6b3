#pragma once

#include "core/shape.hpp"

namespace kairos {
inline namespace core {

// Sizes of the solid that a shape encloses; 0 for a half-space, which has none.

[[nodiscard]] double solid_volume(const Shape& shape);  ///< m^3
[[nodiscard]] double surface_area(const Shape& shape);  ///< m^2

/// The same shape, `size` times as large.
[[nodiscard]] Shape resized(const Shape& shape, double size);

}  // namespace core
}  // namespace kairos
