#pragma once

#include "core/contact_detector.hpp"

#include <memory>

namespace kairos::ccd {

/// The thesis' own detector: the separating-axis test at one instant [Gottschalk1996]. It does not
/// locate: `time_of_impact` tells whether the shapes overlap at the start of the window.
[[nodiscard]] std::unique_ptr<ContactDetector> make_sat();

}  // namespace kairos::ccd
