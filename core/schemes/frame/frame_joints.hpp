#pragma once

#include "core/model.hpp"

#include <string>

namespace kairos {
inline namespace core {

/// Why a scheme that looks at the world once a frame cannot run the joints of a scene; empty if it
/// can. It moves bodies on joints, but joints do not pass its impacts on.
[[nodiscard]] std::string why_not_jointed(const Model& model);

}  // namespace core
}  // namespace kairos
