#pragma once

#include "core/scene.hpp"

#include <string>

namespace kairos {
inline namespace core {

/// How far apart the sides of a joint may be in the scene, as a part of the size of the joint; and
/// how fast they may part, as a part of the speeds of its sides.
inline constexpr double assembly_tolerance = 1e-9;

/// Throws `InputError`, with the line and key of the joint, for a joint that holds nothing
/// movable, whose sides are out of place at t = 0 or part there, or that turns a body that does
/// not turn.
void check_joints(const Scene& scene);

}  // namespace core
}  // namespace kairos
