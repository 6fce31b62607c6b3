#pragma once

#include "core/stepper.hpp"

namespace kairos::integrators {

/// The three Euler steps. p position, v velocity, a acceleration, h the step; rotation goes the
/// same way with the orientation advanced by the exponential of the rotation vector.
///
///   thesis-euler       p += v h, v += a h, a = F/m: all from the old values, so that a lags behind
///                      by one step. It is 0 at the start and survives impacts.
///   explicit-euler     p += v h, v += a h: all from the old values, a current.
///   symplectic-euler   v += a h, then p += v h with the new v.
///
/// The first two draw straight lines on which the velocity changes: it has a polynomial of its own.
/// Under a constant force they gain m |a|^2 h^2 / 2 of energy per step, for ever.

inline constexpr StepperInfo thesis_euler_info{.name = "thesis-euler",
                                               .order = 1,
                                               .position_order = 1,
                                               .velocity_order = 1,
                                               .symplectic = false,
                                               .controlled = false,
                                               .library = "kairos",
                                               .source = "Dembovsky1999"};
inline constexpr StepperInfo explicit_euler_info{.name = "explicit-euler",
                                                 .order = 1,
                                                 .position_order = 1,
                                                 .velocity_order = 1,
                                                 .symplectic = false,
                                                 .controlled = false,
                                                 .library = "kairos",
                                                 .source = "Hairer1993"};
inline constexpr StepperInfo symplectic_euler_info{.name = "symplectic-euler",
                                                   .order = 1,
                                                   .position_order = 1,
                                                   .velocity_order = 1,
                                                   .symplectic = true,
                                                   .controlled = false,
                                                   .library = "kairos",
                                                   .source = "Hairer2006"};

[[nodiscard]] std::unique_ptr<Stepper> make_thesis_euler(const StepperOptions& options);
[[nodiscard]] std::unique_ptr<Stepper> make_explicit_euler(const StepperOptions& options);
[[nodiscard]] std::unique_ptr<Stepper> make_symplectic_euler(const StepperOptions& options);

}  // namespace kairos::integrators
