#pragma once

#include "core/contact_detector.hpp"

#include <memory>

namespace kairos::ccd {

/// The thesis' analytic approach (9.1.1.2.2): look at the bodies at instants so close that no
/// movement between two of them exceeds half of the smallest extent (fig. 15), and where the second
/// of two overlaps, bisect to the first contact.
///
/// What it can miss: a contact that begins and ends between two looks (a corner cut by less than
/// the movement, a turning edge), and of two contacts between two looks the first. The test
/// "bisection misses a grazed corner" shows it.
[[nodiscard]] std::unique_ptr<ContactDetector> make_bisection();

}  // namespace kairos::ccd
