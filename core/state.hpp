#pragma once

#include "core/pose.hpp"

#include <vector>

namespace kairos {
inline namespace core {

/// Position and velocity of one body (SI units, world frame).
struct BodyState {
  Pose pose;
  Twist twist;
};

/// All bodies of a model at one instant, contiguous, indexed by `BodyIndex`.
using State = std::vector<BodyState>;
/// Index of a body in its scene: the order of creation, which the `original` scheme depends on.
using BodyIndex = std::size_t;

}  // namespace core
}  // namespace kairos
