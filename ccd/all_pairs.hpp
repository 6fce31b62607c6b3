#pragma once

#include "core/broad_phase.hpp"

#include <memory>

namespace kairos::ccd {

/// `all-pairs`: the thesis' broad phase (3.5.2), which is none: everybody is near everybody.
[[nodiscard]] std::unique_ptr<BroadPhase> make_all_pairs(std::size_t bodies);

}  // namespace kairos::ccd
