#pragma once

#include "core/stepper.hpp"

namespace kairos::integrators {

/// Multistep methods of SUNDIALS' CVODE [Hindmarsh2005]: Adams-Moulton of orders 1 to 12 with
/// functional iteration, and BDF of orders 1 to 5 with Newton's method for stiff forces.
///
/// Dense output is CVODE's own interpolant, the Nordsieck array, copied: the library's is valid on
/// the last step only. Its steps are as long as they like; what is asked for is cut from them, so
/// that frames do not shorten them. Each step's polynomial is tilted, within the tolerance, to
/// start at the state bit for bit. After an impact the history is worthless and order starts again
/// at 1.
inline constexpr StepperInfo cvode_adams_info{.name = "cvode-adams",
                                              .order = 12,
                                              .position_order = 12,
                                              .velocity_order = 12,
                                              .symplectic = false,
                                              .controlled = true,
                                              .library = "SUNDIALS",
                                              .source = "Hindmarsh2005",
                                              .variable_order = true};
inline constexpr StepperInfo cvode_bdf_info{.name = "cvode-bdf",
                                            .order = 5,
                                            .position_order = 5,
                                            .velocity_order = 5,
                                            .symplectic = false,
                                            .controlled = true,
                                            .library = "SUNDIALS",
                                            .source = "Hindmarsh2005",
                                            .variable_order = true};

[[nodiscard]] std::unique_ptr<Stepper> make_cvode_adams(const StepperOptions& options);
[[nodiscard]] std::unique_ptr<Stepper> make_cvode_bdf(const StepperOptions& options);

}  // namespace kairos::integrators
