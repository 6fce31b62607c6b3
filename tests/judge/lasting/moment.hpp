#pragma once

#include "core/trajectory.hpp"
#include "tests/judge/lasting/real.hpp"

namespace kairos::judge {

/// A body at one instant, as its motion tells it, in long double and by formulas written anew.
struct Moment {
  Vector position;
  Matrix turned;  ///< columns: the body's axes in the world
  Vector velocity;
  Vector spin;          ///< angular velocity, world frame, rad/s
  Vector acceleration;  ///< derivative of `velocity`, m/s^2
  Vector spinning_up;   ///< derivative of `spin`, rad/s^2
  Vector strays;        ///< derivative of `position` less `velocity`, m/s
  Vector turns_astray;  ///< rate of `turned` less `spin`, rad/s
  Real beyond = 0;      ///< s; how long ago the motion ended

  /// Velocity of its material point at x, m/s.
  [[nodiscard]] Vector at(const Vector& x) const { return velocity + spin.cross(x - position); }
};

/// s seconds after the start of a motion, whether or not that is within it.
[[nodiscard]] Moment moment_of(const Motion& motion, Real s);

/// The motion of a body that holds at t: the last that starts by then.
[[nodiscard]] const Motion& motion_at(const Trajectory& run, BodyIndex body, Instant t);

/// A body at t.
[[nodiscard]] Moment moment_at(const Trajectory& run, BodyIndex body, Instant t);

/// From `a` to `b`, s.
[[nodiscard]] Real seconds(Instant a, Instant b);

}  // namespace kairos::judge
