#pragma once

#include "ccd/rounding/roundoff.hpp"
#include "core/pose.hpp"

namespace kairos::ccd {

/// The outward normal of a half-space at rest in twice the precision. A body that slides along a
/// tilted plane for long is far away in the plane and near it in height: a height computed with a
/// rounded normal would be off by roundoff of the way, one computed with this by roundoff of the
/// height (README, eq. 12).
class PlaneNormal {
 public:
  /// `normal_B` turned by the quaternion (w, x, y, z), which may have any length but 0.
  PlaneNormal(const Vector3& normal_B, const Vector4& q);

  /// The normal, rounded.
  [[nodiscard]] const Vector3& rounded() const { return high_; }
  /// Is it an axis of the world, exactly? Which one, then.
  [[nodiscard]] bool is_axis(int& axis) const;
  /// n . x, rounded once more.
  [[nodiscard]] double height(const Vector3& x) const { return height_of({x, Vector3::Zero()}); }
  /// n . (x - y): the difference is not rounded.
  [[nodiscard]] double height(const Vector3& x, const Vector3& y) const;
  /// Bound of the error of the height h of an x of this 1-norm.
  [[nodiscard]] static double error(double h, double size) {
    return 2.0 * unit_roundoff * std::abs(h) + 64.0 * unit_roundoff * unit_roundoff * size;
  }

 private:
  struct Vector {
    Vector3 high;
    Vector3 low;
  };
  [[nodiscard]] double height_of(const Vector& x) const;

  Vector3 high_;
  Vector3 low_;
};

}  // namespace kairos::ccd
