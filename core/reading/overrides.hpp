#pragma once

#include "core/reading/document.hpp"
#include "core/reading/scene_reader.hpp"

#include <vector>

namespace kairos {
inline namespace core {

/// Replaces values of a parsed scene file before it is read. A key is a path: `duration`,
/// `body.ball.radius` (a body by name), `body[2].mass` (by number, from 0), `frame.jitter`,
/// `body.wall.half_extents[0]`. A key that the scene leaves at its default can be set; a body, a
/// table or an element that the scene does not have cannot: throws `InputError`. Whether the key
/// itself exists is for the reader to say.
void apply_overrides(Value& root, const std::vector<Override>& overrides);

}  // namespace core
}  // namespace kairos
