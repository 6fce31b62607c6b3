#pragma once

#include "core/contact_detector.hpp"

namespace kairos::ccd {

struct AdvancementOptions {
  double tolerance = 0.0;  ///< m; 0: `default_tolerance`
  /// Prove the contact: go on until the gap is roundoff and bracket an overlap. Otherwise the first
  /// gap within the tolerance is called an impact.
  bool prove = true;
};

/// 1e-9 of the smaller extent plus the roundoff of the coordinates reached in the window, m.
[[nodiscard]] double default_tolerance(const MovingShape& a, const MovingShape& b,
                                       const Window& window);

/// Conservative advancement on separation functions with frozen witnesses, for every pair of shapes
/// and every motion [Mirtich1996], [Zhang2006], [Tang2009]. Shapes in the order of their rank; not
/// two half-spaces.
[[nodiscard]] TimeOfImpact advance_to_impact(const MovingShape& a, const MovingShape& b,
                                             const Window& window,
                                             const AdvancementOptions& options);

/// When two shapes that overlap at the start part: advancement inside, by penetration depth over
/// the greatest speed of any point.
[[nodiscard]] TimeOfImpact advance_to_separation(const MovingShape& a, const MovingShape& b,
                                                 const Window& window, double tolerance);

}  // namespace kairos::ccd
