#pragma once

#include "core/model.hpp"

#include <string>

namespace kairos {
inline namespace core {

/// Why a scheme that looks at the world once a frame cannot run the joints of a scene, empty if it
/// can: it moves what hangs on joints and has no impacts that joints pass on.
[[nodiscard]] std::string why_not_jointed(const Model& model);

}  // namespace core
}  // namespace kairos
