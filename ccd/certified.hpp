#pragma once

#include "core/contact_detector.hpp"

#include <memory>

namespace kairos::ccd {

/// Time of impact that can be trusted: every bracket is proven, rounding included; a contact is
/// never missed and never reported late. Closed forms where the gap is a quadratic in time,
/// otherwise advancement on separation functions with frozen witnesses. See ccd/README.md.
[[nodiscard]] std::unique_ptr<ContactDetector> make_certified();

}  // namespace kairos::ccd
