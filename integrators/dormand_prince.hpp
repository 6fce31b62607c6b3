#pragma once

#include "core/stepper.hpp"

namespace kairos::integrators {

/// Dormand and Prince's Runge-Kutta pair of orders 5 and 4 with step control, the last stage the
/// first of the next step, and its continuous extension [Dormand1980], [Hairer1993, II.5, II.6].
///
/// The extension is a quartic whose error within a step is O(h^5), no more than what a run has
/// gathered: so the error of a whole motion falls as h^5, in position and in velocity, each of
/// which has a polynomial of its own.
inline constexpr StepperInfo dopri5_info{.name = "dopri5",
                                         .order = 5,
                                         .position_order = 5,
                                         .velocity_order = 5,
                                         .symplectic = false,
                                         .controlled = true,
                                         .library = "kairos",
                                         .source = "Dormand1980"};

[[nodiscard]] std::unique_ptr<Stepper> make_dopri5(const StepperOptions& options);
/// The same for who knows about how long, s, its first step may be.
[[nodiscard]] std::unique_ptr<Stepper> make_dopri5(const StepperOptions& options,
                                                   double first_step);

}  // namespace kairos::integrators
