#pragma once

#include "core/stepper.hpp"

namespace kairos::integrators {

/// The exact motion under constant forces: one `Motion` for any step, infinite steps included (the
/// states are then left where they are: they have no end). Translation is a parabola; a body turns
/// at a constant rate if its moments of inertia are equal or it turns about a principal axis.
///
/// A body that tumbles turns as Jacobi's elliptic functions do [vanZon2007], in segments of a
/// fraction of a turn: quaternion polynomials with a proven error radius, so steps are shorter than
/// asked for.
///
/// The end of a finite step is evaluated in double-double and rounded once, so that energy does
/// not drift by the rounding of the parabola.
inline constexpr StepperInfo closed_form_info{.name = "closed-form",
                                              .order = 0,
                                              .position_order = 0,
                                              .velocity_order = 0,
                                              .symplectic = true,
                                              .controlled = false,
                                              .library = "kairos",
                                              .source = "vanZon2007"};

[[nodiscard]] std::unique_ptr<Stepper> make_closed_form(const StepperOptions& options);

}  // namespace kairos::integrators
