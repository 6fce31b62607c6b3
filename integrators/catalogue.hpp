#pragma once

#include "core/stepper.hpp"

#include <span>

namespace kairos::integrators {

/// A stepper as the registry sees it.
struct CatalogueEntry {
  StepperInfo info;
  StepperFactory make;
};

/// All steppers of this build, in the order in which they are documented. Those of GSL and SUNDIALS
/// are there if it was built with them.
[[nodiscard]] std::span<const CatalogueEntry> catalogue();

}  // namespace kairos::integrators
