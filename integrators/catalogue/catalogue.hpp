#pragma once

#include "core/stepper.hpp"

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kairos::integrators {

/// A stepper as the registry sees it.
struct CatalogueEntry {
  StepperInfo info;
  StepperFactory make;
};

/// All steppers of this build, in the order in which they are documented. Those of GSL and SUNDIALS
/// are there if it was built with them.
[[nodiscard]] std::span<const CatalogueEntry> catalogue();

/// Name and version of the libraries that integrate, as they are loaded.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> solver_versions();

}  // namespace kairos::integrators
