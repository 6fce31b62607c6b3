#include "core/rotation_between.hpp"

namespace kairos {
inline namespace core {

Quaternion rotation_between(const Vector3& from, const Vector3& to) {
  return Quaternion::FromTwoVectors(from, to);
}

}  // namespace core
}  // namespace kairos
