#pragma once

#include "core/double_double.hpp"
#include "core/stepper.hpp"

namespace kairos::integrators {

/// Steps of one coordinate under a constant acceleration, written once for `double`, which is what
/// runs, and for `DoubleDouble`, which tells what rounding did to it.
template <typename Real>
struct Coordinate {
  Real position;  ///< m
  Real velocity;  ///< m/s
};

/// Explicit Euler and the thesis' [Dembovsky1999, 13.4]: everything from the old values.
template <typename Real>
Coordinate<Real> euler_step(const Real& p, const Real& v, const Real& a, const Real& h) {
  return {p + v * h, v + a * h};
}

/// The uniform motion of symplectic Euler with the velocity v1 at the end of its step, at local
/// time s; s = h is the step itself.
template <typename Real>
Coordinate<Real> symplectic_step(const Real& p, const Real& v, const Real& v1, const Real& a,
                                 const Real& s) {
  return {p + v1 * s, v + a * s};
}

/// What every consistent method of order 2 or more does under a constant acceleration.
template <typename Real>
Coordinate<Real> parabola_step(const Real& p, const Real& v, const Real& a, const Real& h) {
  return {p + (v + a * h * Real(0.5)) * h, v + a * h};
}

/// The acceleration F / m of a coordinate in double-double, if `used` is that quotient rounded;
/// otherwise `used` itself (a lagged acceleration from before the force changed).
inline DoubleDouble exact_acceleration(double force, double mass, double used) {
  return force / mass == used ? DoubleDouble(force) / DoubleDouble(mass) : DoubleDouble(used);
}

inline void store(const Coordinate<DoubleDouble>& from, int axis, ReplayedStep& to) {
  to.position_high[axis] = from.position.high;
  to.position_low[axis] = from.position.low;
  to.velocity_high[axis] = from.velocity.high;
  to.velocity_low[axis] = from.velocity.low;
}

/// `Stepper::replay` for the methods whose step is a parabola.
inline bool replay_parabola(const Island& island, double s, std::span<const BodyState> before,
                            std::span<ReplayedStep> after) {
  if (!island.constant_acceleration()) {
    return false;
  }
  for (std::size_t i = 0; i < before.size(); ++i) {
    const DoubleDouble mass(island.inertia[i].mass);
    for (int axis = 0; axis < 3; ++axis) {
      store(parabola_step<DoubleDouble>(before[i].pose.position[axis], before[i].twist.linear[axis],
                                        DoubleDouble(island.constant_force[i][axis]) / mass, s),
            axis, after[i]);
    }
  }
  return true;
}

}  // namespace kairos::integrators
