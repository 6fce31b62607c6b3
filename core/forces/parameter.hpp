#pragma once

#include "core/error.hpp"
#include "core/pose.hpp"

#include <cmath>
#include <string>

namespace kairos {
inline namespace core {

/// Parameters of forces as they are given by a person: throw `InputError` where they make no sense.
inline double not_negative(const char* key, double value) {
  if (!std::isfinite(value) || value < 0.0) {
    throw InputError({}, 0, key, "must be finite and >= 0");
  }
  return value;
}
inline Vector3 finite(const char* key, const Vector3& value) {
  if (!value.allFinite()) {
    throw InputError({}, 0, key, "must be finite");
  }
  return value;
}

}  // namespace core
}  // namespace kairos
