#pragma once

#include "core/scheme.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// `bisected`: the substeps of fig. 15; when one ends in overlap, the first contact within it is
/// located (by the detector: bisection in the thesis' words), handled there, and the frame goes on
/// from there. A contact that begins and ends within one substep is still missed.
[[nodiscard]] std::unique_ptr<Scheme> make_bisected();

}  // namespace core
}  // namespace kairos
