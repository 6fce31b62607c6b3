#pragma once

#include "core/stepper.hpp"

#include <memory>

namespace kairos::integrators {

/// The closed form, and `otherwise` from where it gives up (a build without elliptic functions; a
/// top about its middle axis but for less than doubles resolve) until the state jumps again. What
/// it tells of itself is what it used last.
[[nodiscard]] std::unique_ptr<Stepper> make_closed_form_or(std::unique_ptr<Stepper> otherwise);

}  // namespace kairos::integrators
