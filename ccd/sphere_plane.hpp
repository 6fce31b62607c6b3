#pragma once

#include "core/contact_detector.hpp"

#include <optional>

namespace kairos::ccd {

/// A sphere (a) and a half-space (b) that does not turn, both on parabolas: the gap is a quadratic
/// in time. Empty for any other pair.
[[nodiscard]] std::optional<TimeOfImpact> sphere_plane_impact(const MovingShape& a,
                                                              const MovingShape& b,
                                                              const Window& window);
/// The same of a ball that never ends above a half-space at rest, bit for bit; also empty where a
/// query might have to be refused.
[[nodiscard]] std::optional<TimeOfImpact> sphere_plane_impact(const BallFlight& ball,
                                                              const HalfSpace& half_space,
                                                              const Pose& at_rest,
                                                              const Window& window);
/// When the two part.
[[nodiscard]] std::optional<TimeOfImpact> sphere_plane_separation(const MovingShape& a,
                                                                  const MovingShape& b,
                                                                  const Window& window);

}  // namespace kairos::ccd
