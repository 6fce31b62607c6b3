#pragma once

#include "core/stepper.hpp"

namespace kairos::integrators {

/// Explicit Runge-Kutta methods of SUNDIALS' ARKODE [Reynolds2023], [Hindmarsh2005] of orders 2 to
/// 6 and 8, its default table of each order, with Hermite dense output of that order.
///
/// ERKStep keeps the length of its last step when it is reset. Here no step is longer than what was
/// asked for (a stop time), so it cannot leap over what comes next.
inline constexpr StepperInfo arkode_info(std::string_view name, int order) {
  return {.name = name,
          .order = order,
          .position_order = order,
          .velocity_order = order,
          .symplectic = false,
          .controlled = true,
          .library = "SUNDIALS",
          .source = "Reynolds2023"};
}

[[nodiscard]] std::unique_ptr<Stepper> make_arkode_2(const StepperOptions& options);
[[nodiscard]] std::unique_ptr<Stepper> make_arkode_3(const StepperOptions& options);
[[nodiscard]] std::unique_ptr<Stepper> make_arkode_4(const StepperOptions& options);
[[nodiscard]] std::unique_ptr<Stepper> make_arkode_5(const StepperOptions& options);
[[nodiscard]] std::unique_ptr<Stepper> make_arkode_6(const StepperOptions& options);
[[nodiscard]] std::unique_ptr<Stepper> make_arkode_8(const StepperOptions& options);

}  // namespace kairos::integrators
