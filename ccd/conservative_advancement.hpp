#pragma once

#include "core/contact_detector.hpp"

#include <memory>

namespace kairos::ccd {

/// Conservative advancement [Mirtich1996], [Zhang2006], [Tang2009]: steps that cannot pass a
/// contact, until the gap is within the tolerance; that gap is then called an impact. Its
/// `separated` holds, but a pass within the tolerance is an impact, and no contact is proven.
[[nodiscard]] std::unique_ptr<ContactDetector> make_conservative_advancement();

}  // namespace kairos::ccd
