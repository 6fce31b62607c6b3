#pragma once

#include "core/contact_detector.hpp"

#include <span>

namespace kairos::ccd {

/// `ContactDetector::clear_times` for `certified`: the closed form of two balls in doubles, without
/// error bounds. Instead reaches are 2^-22 larger, which is more than all that is rounded; pairs of
/// which that does not hold (far from the origin, or fast, for their size) and pairs of different
/// accelerations are let through.
void filter_balls(const FlightsBeside& balls, double tolerance, std::span<double> clear);

}  // namespace kairos::ccd
