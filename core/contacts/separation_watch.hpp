#pragma once

#include "core/contacts/turning_step.hpp"

#include <optional>

namespace kairos {
inline namespace core {

/// Watches that a plane separates two bodies in touch along their motions.
///
/// A plane of a face goes with its body: the heights of the other's corners over it have second
/// derivatives that the motions' polynomials bound, so that heights at two times bound those
/// between from below: sag <= bound (s1 - s0)^2 / 8. Planes through touches of two edges, or of
/// balls, go with both bodies; their heights are bounded likewise, by what the motions' bounds
/// give. Where none of these separates the two at the start, or by next to nothing, and their
/// shapes are known, the plane of another face or across other edges is watched.
struct SeparationWatch {
  const TurningPair& pair;
  Motion motion_a;
  Motion motion_b;
  std::vector<Touch> held;  ///< touches whose gaps are held; their corners are not asked about
  /// Touches of which nothing holds the gaps: no corner of theirs comes nearer than it may, either.
  std::vector<Touch> open;
  /// What comes nearer than this part of `TurningPair::nearest`, or of what it is away at the start
  /// if that is less, strikes.
  double least = 0.9375;

  /// The last time within `duration`, s, up to which no corner that is not held comes as near as it
  /// may not; `duration` where none does.
  [[nodiscard]] double strike_time(double duration) const;
};

}  // namespace core
}  // namespace kairos
