#pragma once

#include "core/broad_phase.hpp"

#include <memory>

namespace kairos::ccd {

/// `dynamic-tree`: a binary tree of boxes, grown by the least added surface [Ericson2005,
/// sec. 6.2], in which a body is put anew whenever its swept box changes. Bodies without bounds are
/// kept apart and are near all.
[[nodiscard]] std::unique_ptr<BroadPhase> make_dynamic_tree(std::size_t bodies);

}  // namespace kairos::ccd
