#include "core/contacts/curved_slip.hpp"

#include "core/exponential.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kairos {
inline namespace core {
namespace {

constexpr int order = 11;  // of the direction; two less than positions may have
/// The last terms of a series are below this part of its sum, and so below its roundoff.
constexpr double last_term = 0x1p-56;

}  // namespace

CurvedSlip curved_slip(const Vector3& slip, const Vector3& pull, double brake, double at_most) {
  std::array<Vector3, order + 1> u{};
  std::array<Vector3, order + 1> d{};
  std::array<double, order + 1> speed{};
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  u[0] = slip;
  speed[0] = slip.norm();
  d[0] = slip / speed[0];
  for (int k = 0; k < order; ++k) {
    // Solves u' = pull - brake d, speed^2 = u.u, speed d = u by their coefficients.
    u[at(k + 1)] = ((k == 0 ? pull : Vector3(Vector3::Zero())) - brake * d[at(k)]) / (k + 1.0);
    double square = 0.0;
    for (int i = 0; i <= k + 1; ++i) {
      square += u[at(i)].dot(u[at(k + 1 - i)]);
    }
    for (int i = 1; i <= k; ++i) {
      square -= speed[at(i)] * speed[at(k + 1 - i)];
    }
    speed[at(k + 1)] = square / (2.0 * speed[0]);
    Vector3 rest = u[at(k + 1)];
    for (int i = 1; i <= k + 1; ++i) {
      rest -= speed[at(i)] * d[at(k + 1 - i)];
    }
    d[at(k + 1)] = rest / speed[0];
  }
  CurvedSlip curve;
  // The body cannot stop within half of this time.
  curve.duration = std::min(at_most, 0.5 * speed[0] / (brake + pull.norm()));
  for (int k = order - 1; k <= order; ++k) {
    const double size = std::max(d[at(k)].norm(), std::abs(speed[at(k)]) / speed[0]);
    if (size > 0.0) {
      curve.duration = std::min(curve.duration, power(last_term / size, 1.0 / k));
    }
  }
  curve.direction.resize(order);
  curve.speed.resize(order);
  for (int k = 0; k <= order; ++k) {
    curve.direction[k] = d[at(k)];
    curve.speed[k] = Vector3(speed[at(k)], 0.0, 0.0);
  }
  return curve;
}

}  // namespace core
}  // namespace kairos
