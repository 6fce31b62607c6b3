#pragma once

#include "core/reading/table_reader.hpp"
#include "core/scene.hpp"

namespace kairos {
inline namespace core {

/// Reads one `[[joint]]` between bodies of `scene`, which have been read, and adds it to the scene.
/// Whether its sides fit is for `check_joints` to say. Throws `InputError`.
void read_joint(const Item& item, Scene& scene);

}  // namespace core
}  // namespace kairos
