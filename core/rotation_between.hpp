#pragma once

#include "core/pose.hpp"

namespace kairos {
inline namespace core {

/// The smallest rotation that turns the direction of `from` into that of `to`; about any axis
/// across them if they are opposite. Neither may be zero. Eigen's, which is compiled here alone.
[[nodiscard]] Quaternion rotation_between(const Vector3& from, const Vector3& to);

}  // namespace core
}  // namespace kairos
