#pragma once

#include "core/contacts/touch.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace kairos {
inline namespace core {

/// The vertices and edges of a box or a hull.
struct Corners {
  std::vector<Vector3> vertices;                  ///< body frame, m
  std::vector<std::array<std::size_t, 2>> edges;  ///< between which of them
  double rounding = 0.0;                          ///< m
  double size = 0.0;                              ///< how far out they are, m
};

/// nullopt: the shape has none.
[[nodiscard]] std::optional<Corners> polytope_corners(const Shape& shape);

/// The radius of the side of a capsule or a cylinder, which is about y.
[[nodiscard]] std::optional<double> radius_of_side(const Shape& shape);

/// The rims of a cylinder, or that of a cone.
[[nodiscard]] std::vector<TouchFeature> rims_of_shape(const Shape& shape);

/// The flat face within a rim.
[[nodiscard]] TouchFeature disc_of(const TouchFeature& rim);

}  // namespace core
}  // namespace kairos
