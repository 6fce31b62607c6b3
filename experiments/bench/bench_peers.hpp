#pragma once

#include "ccd/oriented_box.hpp"
#include "core/motion.hpp"
#include "core/shape.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace kairos::experiments {

/// Two boxes and how they move in a window of 1 s, with the poses at its end that others want. Kept
/// small, so that many distinct pairs are no test of the memory.
struct BoxPair {
  Box a, b;
  Pose start_a, start_b;
  Pose end_a, end_b;
  Twist twist_a, twist_b;
};

/// Boxes of 0.2 to 1 m at a distance around `spread` (at 1.4 about half of them overlap) that fly
/// past or into each other within 1 s, turning by up to `turn` rad each.
[[nodiscard]] std::vector<BoxPair> random_box_pairs(std::size_t count, double spread, double turn);

/// Answers the pairs [first, last): the time of impact (s), infinity for none; overlap: 0.
using Contest =
    std::function<void(std::size_t first, std::size_t last, std::vector<double>& answers)>;

/// A measured peer: a library that was found when kairos was built. Never needed to build. Each
/// function prepares what the library wants to have at hand, outside the time that is measured; it
/// is empty where the library has no such query. `tolerance`: of the time, as a fraction of the
/// window, where the library lets one choose.
struct PeerQuery {
  std::string name;
  std::function<Contest(const std::vector<BoxPair>&)> overlaps;
  std::function<Contest(const std::vector<BoxPair>&, double tolerance)> impacts;
};

/// FCL, if it was found.
[[nodiscard]] std::vector<PeerQuery> fcl_peers();
/// Bullet, if it was found.
[[nodiscard]] std::vector<PeerQuery> bullet_peers();

/// Steps ODE's world with a ball that bounces on a plane and returns the number of steps; 0 if
/// ODE was not found.
[[nodiscard]] std::int64_t ode_bounce(std::int64_t steps, double frame);
[[nodiscard]] bool has_ode();

}  // namespace kairos::experiments
