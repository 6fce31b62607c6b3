#pragma once

#include "core/stepper.hpp"

namespace kairos::integrators {

/// Symmetric splittings of rigid bodies under forces with a potential: kick (forces change linear
/// and angular momentum), drift (bodies move freely), kick. The free top is itself split into
/// rotations about its principal axes [McLachlan1993], [Hairer2006, VII.5.3], which are exact: the
/// angular momentum of a free top is kept to roundoff, for ever, and its energy stays bounded.
///
///   free-top-splitting   one such step: order 2
///   forest-ruth          three, with steps w, 1 - 2w, w; w = 1/(2 - 2^(1/3)): order 4
///                        [Forest1990], [Yoshida1990]
///   suzuki4              five, with steps w, w, 1 - 4w, w, w; w = 1/(4 - 4^(1/3)): order 4, with
///   an
///                        error some 60 times smaller on a Kepler orbit [Suzuki1990]
///
/// Forces without a potential (drag) are refused: the order and the structure would be lost.
inline constexpr StepperInfo free_top_splitting_info{.name = "free-top-splitting",
                                                     .order = 2,
                                                     .position_order = 2,
                                                     .velocity_order = 2,
                                                     .symplectic = true,
                                                     .controlled = false,
                                                     .library = "kairos",
                                                     .source = "McLachlan1993"};
inline constexpr StepperInfo forest_ruth_info{.name = "forest-ruth",
                                              .order = 4,
                                              .position_order = 4,
                                              .velocity_order = 4,
                                              .symplectic = true,
                                              .controlled = false,
                                              .library = "kairos",
                                              .source = "Forest1990"};
inline constexpr StepperInfo suzuki4_info{.name = "suzuki4",
                                          .order = 4,
                                          .position_order = 4,
                                          .velocity_order = 4,
                                          .symplectic = true,
                                          .controlled = false,
                                          .library = "kairos",
                                          .source = "Suzuki1990"};

[[nodiscard]] std::unique_ptr<Stepper> make_free_top_splitting(const StepperOptions& options);
[[nodiscard]] std::unique_ptr<Stepper> make_forest_ruth(const StepperOptions& options);
[[nodiscard]] std::unique_ptr<Stepper> make_suzuki4(const StepperOptions& options);

}  // namespace kairos::integrators
