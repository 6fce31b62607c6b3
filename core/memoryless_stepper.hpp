#pragma once

#include "core/stepper.hpp"

namespace kairos {
inline namespace core {

/// A stepper that says so by being one: at constant forces, of bodies that do not turn, a step
/// lasts as long as it is asked to, for ever if need be; and after `restart` nothing depends on
/// what was before. Bodies that fall freely can share one.
class MemorylessStepper : public Stepper {};

}  // namespace core
}  // namespace kairos
