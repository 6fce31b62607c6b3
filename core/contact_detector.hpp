#pragma once

#include "core/ball_flight.hpp"
#include "core/contact_manifold.hpp"
#include "core/motion.hpp"
#include "core/shape.hpp"
#include "core/time_of_impact.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kairos {
inline namespace core {

/// A shape and how it moves.
struct MovingShape {
  const Shape& shape;
  const Motion& motion;
};

/// The stretch of time that a query looks at.
struct Window {
  Instant start;          ///< within both motions
  double duration = 0.0;  ///< s, >= 0; within both motions; may be infinite where both are
};

/// What a detector is, and what it can do.
struct DetectorInfo {
  std::string_view name;
  bool locates = false;  ///< answers `time_of_impact` with a time, not only with yes or no
  bool proves = false;   ///< its `separated` and its brackets are proven, rounding included
  std::string_view summary;
  /// Tells only contacts at which a stepper ended its step (see `Stepper::watch`).
  bool at_step_ends = false;
};

/// Port: are these two touching, and since when? Stateless; safe to share between threads. Queries
/// without an answer (an extent that is not positive, a quaternion that is not unit, a window
/// longer than a motion, NaN) throw `std::invalid_argument`.
class ContactDetector {
 public:
  virtual ~ContactDetector() = default;
  /// The same for the whole life of the detector.
  [[nodiscard]] virtual DetectorInfo info() const = 0;

  /// Do they overlap at these poses? Only the boolean: the cheap question of every frame.
  [[nodiscard]] virtual bool overlaps(const Shape& a, const Pose& pose_a, const Shape& b,
                                      const Pose& pose_b) const = 0;
  /// The same with signed gap, normal (a to b) and the centroid of the contact patch.
  [[nodiscard]] virtual Overlap overlap(const Shape& a, const Pose& pose_a, const Shape& b,
                                        const Pose& pose_b) const = 0;
  /// The patch in which they touch: its points whose gap is at most `reach`, m (none where they are
  /// further apart). The default knows only the centroid.
  [[nodiscard]] virtual ContactManifold manifold(const Shape& a, const Pose& pose_a, const Shape& b,
                                                 const Pose& pose_b, double reach) const;
  /// When do they first touch within the window? `tolerance` in m; 0 takes the default:
  /// 1e-9 of the smaller extent plus the roundoff of the coordinates.
  [[nodiscard]] virtual TimeOfImpact time_of_impact(const MovingShape& a, const MovingShape& b,
                                                    const Window& window,
                                                    double tolerance) const = 0;
  /// The same of two balls on parabolas without an error radius that never end, perhaps sooner;
  /// nothing: `time_of_impact` has to be asked, as always by default.
  [[nodiscard]] virtual std::optional<TimeOfImpact> ball_impact(const BallFlight& a,
                                                                const BallFlight& b,
                                                                const Window& window) const;
  /// For each of these balls, a time before which `time_of_impact` with the same tolerance finds
  /// no contact with the one: s after the later of their starts; infinite: never. Lower bounds,
  /// used to leave queries out and in no answer; the default is 0. `clear` has room for all
  /// blocks.
  virtual void clear_times(const FlightsBeside& balls, double tolerance,
                           std::span<double> clear) const;
  /// Two shapes that overlap at the start: when do they part? `impact` brackets the parting
  /// (still overlapping, or touching within tolerance, at t_lo; apart at t_hi); `overlapping`:
  /// not within the window; `separated`: apart at the start already. For fields.
  [[nodiscard]] virtual TimeOfImpact time_of_separation(const MovingShape& a, const MovingShape& b,
                                                        const Window& window,
                                                        double tolerance) const = 0;
  /// The thesis' geometric approach (fig. 14): do the boxes that the two shapes sweep over the
  /// window overlap? A "no" is proven; a "yes" says only that they could have met.
  [[nodiscard]] virtual bool swept_overlap(const MovingShape& a, const MovingShape& b,
                                           const Window& window) const = 0;
};

}  // namespace core
}  // namespace kairos
