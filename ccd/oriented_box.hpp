#pragma once

#include "core/pose.hpp"

namespace kairos::ccd {

/// An oriented box in the world.
struct OrientedBox {
  Vector3 centre = Vector3::Zero();        ///< m
  Matrix3 axes = Matrix3::Identity();      ///< columns, orthonormal
  Vector3 half_extents = Vector3::Zero();  ///< m
};

}  // namespace kairos::ccd
