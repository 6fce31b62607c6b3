#pragma once

#include "core/pose.hpp"

#include <array>

namespace kairos::ccd {

/// The convex hull of all that a box passes: the box itself, or a solid of revolution if it spins
/// about an axis through its origin (eq. 8). A proposer of directions: what they separate is proven
/// by supports.
class SpunBox {
 public:
  /// `centre` and the columns of `axes`: world frame; half extents of 0 are a point.
  SpunBox(const Vector3& half, const Vector3& centre, const Matrix3& axes)
      : centre_(centre), axes_(axes), half_(half) {}
  /// The same of a box that spins about `w`, of any length but 0.
  static SpunBox spinning(const Vector3& half, const Vector3& centre, const Matrix3& axes,
                          const Vector3& w);

  /// Its point nearest to x; x itself inside.
  [[nodiscard]] Vector3 nearest(const Vector3& x) const;

 private:
  /// A quarter of the profile, which is symmetric: along the axis and away from it, convex, from
  /// (0, greatest radius) to (greatest height, 0).
  struct Corner {
    double along = 0.0;
    double away = 0.0;
  };

  Vector3 centre_;
  Matrix3 axes_;
  Vector3 half_;
  Vector3 w_ = Vector3::Zero();  ///< unit; 0: it does not spin
  std::array<Corner, 6> profile_{};
  int corners_ = 0;
};

/// The direction from a to b between their nearest points, by projecting onto each in turn
/// [Cheney1959]; 0 if they meet.
[[nodiscard]] Vector3 direction_between(const SpunBox& a, const SpunBox& b, const Vector3& start);

}  // namespace kairos::ccd
