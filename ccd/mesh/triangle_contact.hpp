#pragma once

#include "ccd/mesh/mesh_pair.hpp"

#include <cstdint>

namespace kairos::ccd {

/// What doubles can prove.
enum class FloatVerdict : std::uint8_t { apart, touching, unknown };

/// The sign of (b - a) . ((c - a) x (d - a)), 0 where rounding hides it. `bound`: of
/// `orientation_error`.
[[nodiscard]] inline int float_orientation(const Vector3& a, const Vector3& b, const Vector3& c,
                                           const Vector3& d, double bound) {
  const double volume = (b - a).dot((c - a).cross(d - a));
  return volume > bound ? 1 : (volume < -bound ? -1 : 0);
}
/// Bounds what `float_orientation` of points is off by: their coordinates by `error` each, and at
/// most `extent` apart along any axis. Infinite where nothing is proven.
[[nodiscard]] double orientation_error(double extent, double error);

/// Do two triangles touch? By the sides of six corners and of two pairs of edges [Devillers2002].
[[nodiscard]] FloatVerdict float_triangles_touch(const Corners& a, const Corners& b, double error);

/// The same without an error: in doubles where they prove it, otherwise in whole numbers. `exact`
/// counts how often those were asked.
[[nodiscard]] bool triangles_touch(const MeshPair& pair, std::uint32_t triangle_a,
                                   std::uint32_t triangle_b, std::int64_t& exact);

}  // namespace kairos::ccd
