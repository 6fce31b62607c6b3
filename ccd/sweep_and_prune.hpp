#pragma once

#include "core/broad_phase.hpp"

#include <memory>

namespace kairos::ccd {

/// `sweep-and-prune`: bodies sorted by the lower end of their boxes along x; who is near is found
/// in a stretch of that order [Cohen1995]. The order is kept by moving one entry at a time, which
/// costs little where bodies move little between updates. Bodies without bounds along x are near
/// all.
[[nodiscard]] std::unique_ptr<BroadPhase> make_sweep_and_prune(std::size_t bodies);

}  // namespace kairos::ccd
