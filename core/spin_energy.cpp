#include "core/spin_energy.hpp"

#include "core/double_double.hpp"

#include <array>

namespace kairos {
inline namespace core {
namespace {

using Three = std::array<DoubleDouble, 3>;

Three cross(const Vector3& a, const Three& b) {
  const auto component = [&](int i, int j) {
    return DoubleDouble(a[i]) * b[static_cast<std::size_t>(j)] -
           DoubleDouble(a[j]) * b[static_cast<std::size_t>(i)];
  };
  return {component(1, 2), component(2, 0), component(0, 1)};
}

}  // namespace

/// R(q)^-1 x = x + 2 (v x (v x x) - s v x x) / |q|^2 for q = (s, v).
Vector3 principal_rates(const BodyInertia& inertia, const BodyState& state) {
  const Quaternion q = inertia.principal_axes(state.pose.orientation);
  const Vector3& x = state.twist.angular;
  DoubleDouble length = two_product(q.w(), q.w());
  for (int k = 0; k < 3; ++k) {
    length = length + two_product(q.vec()[k], q.vec()[k]);
  }
  const Three once = cross(q.vec(), {x[0], x[1], x[2]});
  const Three twice = cross(q.vec(), once);
  Vector3 rates;
  for (std::size_t k = 0; k < 3; ++k) {
    const DoubleDouble turned = twice[k] - DoubleDouble(q.w()) * once[k];
    const auto axis = static_cast<Eigen::Index>(k);
    rates[axis] = (DoubleDouble(x[axis]) + DoubleDouble(2.0) * turned / length).rounded();
  }
  return rates;
}

double spin_energy(const BodyInertia& inertia, const BodyState& state) {
  const Vector3 w_B = principal_rates(inertia, state);
  return 0.5 * w_B.dot(inertia.principal.cwiseProduct(w_B));
}

}  // namespace core
}  // namespace kairos
