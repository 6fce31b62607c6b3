#pragma once

#include "core/stepper.hpp"

namespace kairos::integrators {

/// Munthe-Kaas' Lie-group method on the classical Runge-Kutta tableau [MuntheKaas1998],
/// [Hairer2006, IV.8]: the orientation within a step is q = exp(theta/2) q0, and it is the rotation
/// vector theta that is integrated,
///
///   theta' = dexp^-1(theta) w = w - theta x w / 2 + theta x (theta x w) / 12 + O(theta^4),
///
/// so orientations stay unit quaternions without being normalised. Translation as in `rk4`.
inline constexpr StepperInfo rkmk4_info{.name = "rkmk4",
                                        .order = 4,
                                        .position_order = 4,
                                        .velocity_order = 4,
                                        .symplectic = false,
                                        .controlled = false,
                                        .library = "kairos",
                                        .source = "MuntheKaas1998"};

[[nodiscard]] std::unique_ptr<Stepper> make_rkmk4(const StepperOptions& options);

}  // namespace kairos::integrators
