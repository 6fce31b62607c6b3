#pragma once

#include "core/scene.hpp"

#include <string_view>

namespace kairos::studio {

/// The scene as it goes on from a later moment: bodies are where `start` (see `Request`) says, and
/// what drives others is as far on as the clock. Names that the scene has no more are passed over.
/// Throws `InputError` where a line cannot be read.
void start_later(Scene& scene, std::string_view start);

}  // namespace kairos::studio
