#pragma once

#include "core/pose.hpp"

#include <Eigen/Core>

namespace kairos::judge {

/// 64 bits of mantissa: rounding is 2048 times below that of what is judged.
using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;
using Matrix = Eigen::Matrix<Real, 3, 3>;
using Column = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

inline Vector real(const Vector3& v) { return v.cast<Real>(); }

}  // namespace kairos::judge
