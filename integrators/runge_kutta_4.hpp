#pragma once

#include "core/stepper.hpp"

namespace kairos::integrators {

/// The classical Runge-Kutta method of order 4 [Hairer1993, II.1]; quintic Hermite positions.
///
///     0 |
///   1/2 | 1/2
///   1/2 |  0  1/2
///     1 |  0   0   1
///   ----+-----------------
///         1/6 1/3 1/3 1/6
inline constexpr StepperInfo rk4_info{.name = "rk4",
                                      .order = 4,
                                      .position_order = 4,
                                      .velocity_order = 4,
                                      .symplectic = false,
                                      .controlled = false,
                                      .library = "kairos",
                                      .source = "Hairer1993"};

[[nodiscard]] std::unique_ptr<Stepper> make_rk4(const StepperOptions& options);

}  // namespace kairos::integrators
