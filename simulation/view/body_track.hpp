#pragma once

#include "core/motion.hpp"
#include "core/state.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace kairos {
inline namespace simulation {

/// The motions of one body through a run, as numbers that a page evaluates.
///
/// A segment counts after its start and up to the start of the next one: at the instant where two
/// meet, the one that arrives counts, which is what a frame shows. Motions that go on as the one
/// before them did (within 1e-11 of a metre, scaled with the coordinates) are one segment.
class BodyTrack {
 public:
  /// What `layout` says of a polynomial that is not stored: the velocity is the derivative of the
  /// position; the angular velocity is the rate of the rotation.
  static constexpr std::uint8_t derived = 255;
  /// `layout` of a rotation that is fixed at the identity, beyond `RotationKind`.
  static constexpr std::uint8_t upright = 3;
  static constexpr std::size_t layout_size = 5;

  /// The body moves like this from `motion.start` on, whatever was said of that time before.
  void add(const Motion& motion);
  /// The last motion counts at its start already: a body that jumped before it was drawn.
  void count_at_start();
  /// Ends the recording; `start` and the rest are complete from here on.
  void finish();

  [[nodiscard]] bool empty() const { return !last_; }
  /// Where the last motion starts. Not empty.
  [[nodiscard]] Instant last_start() const { return last_->start; }
  /// As a page shows it at t, which is not before the last motion but one. Not empty.
  [[nodiscard]] Pose arriving(Instant t) const;
  /// By the last motion. Not empty.
  [[nodiscard]] Pose leaving(Instant t) const;

  std::vector<double> start;         ///< s
  std::vector<double> duration;      ///< s; beyond it the body stays where it is
  std::vector<std::uint8_t> layout;  ///< degrees of position, velocity; rotation; degrees of
                                     ///< quaternion, angular velocity
  std::vector<double> coefficients;  ///< what the layout says, in its order, lowest power first

 private:
  void encode(const Motion& motion, double duration_s);
  void drop_last();

  std::optional<Motion> before_;  ///< the last but one, encoded already
  std::optional<Motion> last_;
};

}  // namespace simulation
}  // namespace kairos
