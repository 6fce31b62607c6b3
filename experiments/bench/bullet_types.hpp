#pragma once

// Our vectors and poses as Bullet's. Included where Bullet was found only.
#include "core/pose.hpp"

#include <LinearMath/btTransform.h>

namespace kairos::experiments {

inline btVector3 vector(const Vector3& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

inline btTransform transform(const Pose& pose) {
  const Quaternion& q = pose.orientation;
  return btTransform(btQuaternion(static_cast<btScalar>(q.x()), static_cast<btScalar>(q.y()),
                                  static_cast<btScalar>(q.z()), static_cast<btScalar>(q.w())),
                     vector(pose.position));
}

}  // namespace kairos::experiments
