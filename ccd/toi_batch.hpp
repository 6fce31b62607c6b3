#pragma once

#include "core/contact_detector.hpp"

#include <span>

namespace kairos::ccd {

/// One question about two moving shapes, which somebody else keeps.
struct ToiQuery {
  MovingShape a;
  MovingShape b;
  Window window;
  double tolerance = 0.0;  ///< m; 0 takes the default
};

/// `time_of_impact` of each, in order. Queries do not depend on each other, and detectors are safe
/// to share: whoever has threads gives each of them a part of the span. Throws
/// `std::invalid_argument` as the detector does, and unless there are as many answers as queries.
void toi_batch(const ContactDetector& detector, std::span<const ToiQuery> queries,
               std::span<TimeOfImpact> answers);

}  // namespace kairos::ccd
