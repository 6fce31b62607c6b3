#include "integrators/dense_output.hpp"

namespace kairos::integrators {

void cubic_rotation(Motion& motion, double h, const BodyState& before, const BodyState& after) {
  const Vector4 q0 = as_vector(before.pose.orientation);
  Vector4 q1 = as_vector(after.pose.orientation);
  if (q0.dot(q1) < 0.0) {
    q1 = -q1;  // the same orientation, on the near side
  }
  const std::array<HermiteNode<4>, 2> nodes{{
      {0.0, 2, {q0, quaternion_rate(before.twist.angular, q0), Vector4::Zero()}},
      {h, 2, {q1, quaternion_rate(after.twist.angular, q1), Vector4::Zero()}},
  }};
  motion.rotation = RotationKind::polynomial;
  motion.quaternion = hermite<4>(nodes);
}

}  // namespace kairos::integrators
