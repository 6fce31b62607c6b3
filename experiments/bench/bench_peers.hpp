#pragma once

#include "core/motion.hpp"
#include "core/shape.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace kairos::experiments {

/// Two boxes and how they move in a window of 1 s.
struct BenchPair {
  Shape a, b;
  Motion motion_a, motion_b;
};

/// A measured peer: a library that was found when kairos was built. Never needed to build.
struct PeerQuery {
  std::string name;
  std::function<std::int64_t(const std::vector<BenchPair>&)> overlaps;  ///< counts; may be empty
  std::function<std::int64_t(const std::vector<BenchPair>&)> impacts;   ///< counts; may be empty
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
