#pragma once

#include "tests/judge/query.hpp"
#include "tests/judge/real.hpp"

namespace kairos::judge {

/// How a body turns from an instant on.
struct Turning {
  Vector<Long> w;      ///< angular velocity at the instant, rad/s
  Long rate = 0;       ///< bound of |w| until the end of the window
  Long change = 0;     ///< bound of |w'|, rad/s^2
  bool steady = true;  ///< w is constant
};
[[nodiscard]] Turning turning_of(const Body& body, Long t, Long end);

/// How its origin moves from an instant on.
struct Travel {
  Vector<Long> velocity;
  Vector<Long> acceleration;  ///< the constant part
  Long change = 0;            ///< bound of the rest of the acceleration until the end, m/s^2
};
[[nodiscard]] Travel travel_of(const Body& body, Long t, Long end);

/// Sum of the lengths that the position at s is a sum of, m.
[[nodiscard]] Long travelled(const Body& body, Long s);
/// How far it has turned by s at most, rad.
[[nodiscard]] Long angle_turned(const Body& body, Long s);

}  // namespace kairos::judge
