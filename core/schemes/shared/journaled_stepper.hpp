#pragma once

#include "core/stepper.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// Makes a checkpoint of any stepper: one that archives itself is returned as it is; one that keeps
/// its memory to itself (a foreign multistep solver) is told again, on resuming, all that it was
/// told since it was started. Detection and impacts are not done again.
[[nodiscard]] std::unique_ptr<Stepper> make_persistent(std::unique_ptr<Stepper> stepper);

}  // namespace core
}  // namespace kairos
