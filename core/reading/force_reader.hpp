#pragma once

#include "core/reading/table_reader.hpp"
#include "core/scene.hpp"

namespace kairos {
inline namespace core {

/// Reads one `[[force]]` that acts on the bodies of `scene`, which have been read, and adds it to
/// the scene: one `SceneForce` per body where it acts on each by itself, one for a pair that it
/// couples. `G`: what the top level of the file says. Throws `InputError`.
void read_force(const Item& item, double G, Scene& scene);

}  // namespace core
}  // namespace kairos
