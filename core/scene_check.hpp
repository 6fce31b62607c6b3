#pragma once

#include "core/scene.hpp"

namespace kairos {
inline namespace core {

/// Refuses a scene that no run could make sense of. A reader has refused most of this already, with
/// the line; a scene that was made in code is checked here first. Throws `InputError`.
void check_scene(const Scene& scene);

}  // namespace core
}  // namespace kairos
