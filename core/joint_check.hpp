#pragma once

#include "core/scene.hpp"

#include <string>

namespace kairos {
inline namespace core {

/// Of the size of a joint: what the scene may leave open where its sides are put together, and of
/// the speeds of its sides: what they may part with.
inline constexpr double assembly_tolerance = 1e-9;

/// Throws `InputError`, with the line and key of the joint, for one that holds nothing that can
/// move, whose sides are not where it puts them at t = 0 or part there, or that turns what does not
/// turn.
void check_joints(const Scene& scene);

}  // namespace core
}  // namespace kairos
