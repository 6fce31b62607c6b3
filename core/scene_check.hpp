#pragma once

#include "core/scene.hpp"

namespace kairos {
inline namespace core {

/// Refuses a scene that no run could make sense of, however it was made (a reader has refused most
/// of this with its line already; a scene made in code comes here first). Throws `InputError`.
void check_scene(const Scene& scene);

}  // namespace core
}  // namespace kairos
