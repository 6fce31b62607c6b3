#pragma once

#include "ccd/pair_motion.hpp"

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

/// What a query about a part of each of two bodies is told.
struct PartQuery {
  double tolerance = 0.0;  ///< m, > 0
  bool prove = true;
  double from = 0.0;         ///< they are proven apart up to here, window time, s
  int most_evaluations = 0;  ///< then it is `undecided` at a gap above the tolerance
};
/// The same for a part of each of two bodies; none of b if that is a half-space. `t_lo` is true of
/// the motions; what others compute there, rounded, is for who puts the answers together.
[[nodiscard]] TimeOfImpact advance_parts(const MovingShape& a, const ConvexCore& part_of_a,
                                         const MovingShape& b, const ConvexCore* part_of_b,
                                         const Window& window, const PartQuery& query);

/// When two shapes that overlap at the start part: advancement inside, by penetration depth over
/// the greatest speed of any point.
[[nodiscard]] TimeOfImpact advance_to_separation(const MovingShape& a, const MovingShape& b,
                                                 const Window& window, double tolerance);

}  // namespace kairos::ccd
