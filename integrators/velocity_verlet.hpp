#pragma once

#include "core/stepper.hpp"

namespace kairos::integrators {

/// Stoermer-Verlet in its velocity form [Hairer2006, I.1.4], one evaluation a step:
///
///   p1 = p + v h + a h^2 / 2,   v1 = v + (a + a1) h / 2,   a1 = a(p1, v + a h).
///
/// Symplectic for forces that depend on position alone; order 2 for all. Exact under a constant
/// force. Rotation: the orientation by the exponential of the mid-step rate, order 2 (structure is
/// kept by `free-top-splitting`, not by this).
inline constexpr StepperInfo velocity_verlet_info{.name = "velocity-verlet",
                                                  .order = 2,
                                                  .position_order = 2,
                                                  .velocity_order = 2,
                                                  .symplectic = true,
                                                  .controlled = false,
                                                  .library = "kairos",
                                                  .source = "Hairer2006"};

[[nodiscard]] std::unique_ptr<Stepper> make_velocity_verlet(const StepperOptions& options);

}  // namespace kairos::integrators
