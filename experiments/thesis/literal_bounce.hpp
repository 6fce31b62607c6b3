#pragma once

#include <cstdint>

namespace kairos::experiments::thesis {

/// A ball over a floor, in the numbers of scene `bounce`.
struct BounceSetting {
  double height = 5.0;        ///< of the centre at the start, m
  double radius = 0.5;        ///< m
  double mass = 1.0;          ///< kg
  double G = 9.8;             ///< N: the thesis' force
  double frame = 1.0 / 60.0;  ///< s
};

template <typename Real>
struct BounceState {
  Real height = 0;
  Real velocity = 0;
  Real acceleration = 0;
  std::int64_t impacts = 0;

  [[nodiscard]] Real energy(const BounceSetting& s) const {
    return Real(s.mass) * velocity * velocity / 2 + Real(s.G) * height;
  }
};

/// One frame of the thesis' stepping (13.1, 13.3, 13.4, 13.7) for one ball and one floor, operation
/// by operation as `original` does it, in any floating-point type: what differs between two types
/// is roundoff and nothing else.
template <typename Real>
void literal_frame(const BounceSetting& s, BounceState<Real>& ball) {
  if (ball.height <= Real(s.radius)) {
    ball.velocity = ball.velocity - 2 * ball.velocity;
    ++ball.impacts;
  }
  const Real force = -Real(s.G);
  ball.height += ball.velocity * Real(s.frame);
  ball.velocity += ball.acceleration * Real(s.frame);
  ball.acceleration = force / Real(s.mass);
}

}  // namespace kairos::experiments::thesis
