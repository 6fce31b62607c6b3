#pragma once

#include "core/stepper.hpp"

namespace kairos::integrators::sundials {

/// See `make_ida`.
[[nodiscard]] std::unique_ptr<Stepper> make_ida_stepper(const StepperOptions& options);

}  // namespace kairos::integrators::sundials
