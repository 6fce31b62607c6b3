#pragma once

#include "core/stepper.hpp"

namespace kairos::integrators {

/// Steppers of the GNU Scientific Library's odeiv2 [Galassi2009] with Hermite dense output of
/// matching order. One meaning of tolerance, as everywhere here: GSL's own controllers are used
/// only where a method cannot do without (`gsl-msadams`, which therefore takes no fixed steps).
///
/// Making one switches GSL's error handler off for the program: it would abort it.

inline constexpr StepperInfo gsl_rkf45_info{.name = "gsl-rkf45",
                                            .order = 5,
                                            .position_order = 5,
                                            .velocity_order = 5,
                                            .symplectic = false,
                                            .controlled = true,
                                            .library = "GSL",
                                            .source = "Galassi2009"};
inline constexpr StepperInfo gsl_rkck_info{.name = "gsl-rkck",
                                           .order = 5,
                                           .position_order = 5,
                                           .velocity_order = 5,
                                           .symplectic = false,
                                           .controlled = true,
                                           .library = "GSL",
                                           .source = "Galassi2009"};
inline constexpr StepperInfo gsl_rk8pd_info{.name = "gsl-rk8pd",
                                            .order = 8,
                                            .position_order = 8,
                                            .velocity_order = 8,
                                            .symplectic = false,
                                            .controlled = true,
                                            .library = "GSL",
                                            .source = "Galassi2009"};
inline constexpr StepperInfo gsl_msadams_info{.name = "gsl-msadams",
                                              .order = 12,
                                              .position_order = 8,
                                              .velocity_order = 6,
                                              .symplectic = false,
                                              .controlled = true,
                                              .library = "GSL",
                                              .source = "Galassi2009",
                                              .variable_order = true};
inline constexpr StepperInfo gsl_bsimp_info{.name = "gsl-bsimp",
                                            .order = 12,
                                            .position_order = 14,
                                            .velocity_order = 12,
                                            .symplectic = false,
                                            .controlled = true,
                                            .library = "GSL",
                                            .source = "Galassi2009",
                                            .variable_order = true};

[[nodiscard]] std::unique_ptr<Stepper> make_gsl_rkf45(const StepperOptions& options);
[[nodiscard]] std::unique_ptr<Stepper> make_gsl_rkck(const StepperOptions& options);
[[nodiscard]] std::unique_ptr<Stepper> make_gsl_rk8pd(const StepperOptions& options);
[[nodiscard]] std::unique_ptr<Stepper> make_gsl_msadams(const StepperOptions& options);
[[nodiscard]] std::unique_ptr<Stepper> make_gsl_bsimp(const StepperOptions& options);

}  // namespace kairos::integrators
