#pragma once

#include "core/stepper.hpp"

#include <memory>

namespace kairos {
inline namespace simulation {

/// A stepper that starts anew at every restart, for the price of it: what it learnt of its step and
/// its order before an impact is lost.
[[nodiscard]] std::unique_ptr<Stepper> with_cold_restarts(std::unique_ptr<Stepper> stepper);

}  // namespace simulation
}  // namespace kairos
