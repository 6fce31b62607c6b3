#pragma once

#include "core/stepper.hpp"
#include "integrators/island_ode.hpp"
#include "integrators/sundials/shim.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos::integrators::sundials {

/// An `IslandOde` as SUNDIALS sees it.
struct IslandSystem {
  IslandOde* ode = nullptr;
  double offset = 0.0;  ///< the system's time minus the solver's, s

  static int rhs(Real t, N_Vector y, N_Vector rate, void* self) {
    auto& system = *static_cast<IslandSystem*>(self);
    system.ode->rhs(system.offset + t, data(y), data(rate));
    return 0;
  }
};

/// Tolerances for SUNDIALS, which takes the root mean square of n scaled errors: divided by sqrt(n)
/// they bound every component, which is what `StepperOptions` means. None is below roundoff.
struct Tolerances {
  Real relative;
  Real absolute;

  Tolerances(const StepperOptions& options, std::size_t size) {
    const double share = 1.0 / std::sqrt(static_cast<double>(size));
    const double least = 10.0 * std::numeric_limits<double>::epsilon();
    relative = std::max(options.relative_tolerance * share, least);
    absolute = std::max(options.absolute_tolerance * share, std::numeric_limits<double>::min());
  }
};

[[nodiscard]] inline bool controlled(const StepperOptions& options) {
  return std::isfinite(options.relative_tolerance) && std::isfinite(options.absolute_tolerance);
}

}  // namespace kairos::integrators::sundials
