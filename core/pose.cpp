#include "core/pose.hpp"

#include "core/circular.hpp"

#include <cmath>

namespace kairos {
inline namespace core {

Quaternion rotate(const Vector3& rotation_W, const Quaternion& q_WB) {
  const double angle = rotation_W.norm();
  const double half = 0.5 * angle;
  // sin(angle/2) / angle, which tends to 1/2; the quotient keeps full precision down to underflow.
  const SineCosine at = sine_cosine(half);
  const double k = angle > 0.0 ? at.sine / angle : 0.5;
  const Quaternion turn(at.cosine, k * rotation_W.x(), k * rotation_W.y(), k * rotation_W.z());
  return turn * q_WB;
}

}  // namespace core
}  // namespace kairos
