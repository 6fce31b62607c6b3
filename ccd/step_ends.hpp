#pragma once

#include "core/contact_detector.hpp"

#include <memory>

namespace kairos::ccd {

/// The textbook's way to locate an event: looks at both ends of a window, and where a gap changes
/// its sign takes the root of the straight line between. Sees nothing that happens in between, and
/// is as late or early as the gap is curved: O(h^2) for a step of h.
[[nodiscard]] std::unique_ptr<ContactDetector> make_linear();

/// For steppers that end their steps at impacts which they find by themselves
/// (`Stepper::watch`): two bodies in touch at the end of a window, and approaching, have met there.
[[nodiscard]] std::unique_ptr<ContactDetector> make_cvode_rootfinding();

}  // namespace kairos::ccd
