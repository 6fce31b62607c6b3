#pragma once

#include "core/reading/body_reader.hpp"

#include <vector>

namespace kairos {
inline namespace core {

/// Reads one `[[many]]`, a body that is written once and the region that holds so many of it, and
/// adds these bodies. Throws `InputError` before anything is added.
void read_many(const Item& item, const BodyDefaults& defaults, std::vector<Body>& bodies);

}  // namespace core
}  // namespace kairos
