#pragma once

#include "core/pose.hpp"

#include <array>
#include <cstdint>

namespace kairos {
inline namespace core {

struct Scene;

/// Which copy of a body is meant: so many boxes further along each axis.
using Image = std::array<std::int32_t, 3>;

/// Whether it is the body itself.
[[nodiscard]] constexpr bool is_zero(const Image& n) { return n == Image{}; }
/// The way back.
[[nodiscard]] constexpr Image operator-(const Image& n) { return {-n[0], -n[1], -n[2]}; }

/// A box that is repeated without end along some of its axes: what leaves it on one side comes in
/// on the other. Positions are not put back into it: a body goes on along its line, and meets the
/// *images* of others, each a whole number of boxes away.
struct PeriodicBox {
  Vector3 lowest = Vector3::Zero();  ///< m
  Vector3 highest = Vector3::Zero();
  std::array<bool, 3> along{};  ///< whether it is repeated along x, y, z

  /// Length of the box along the axes on which it is repeated, m; 0 along the others.
  [[nodiscard]] Vector3 period() const;
  /// From a body to its image, m.
  [[nodiscard]] Vector3 shift(const Image& n) const;
  /// The image that is nearest, of something at `d` (m) from where it is seen.
  [[nodiscard]] Image nearest(const Vector3& d) const;
  /// The place within the box that is the same as p, m.
  [[nodiscard]] Vector3 wrapped(const Vector3& p) const;
};

/// Throws `InputError` where the scene cannot work in its periodic box: two images of one body
/// could meet another at once, a wall or gravity is not the same in the next box, something is
/// driven, hangs on a joint, or feels what depends on where it is.
void check_periodic(const Scene& scene);

}  // namespace core
}  // namespace kairos
