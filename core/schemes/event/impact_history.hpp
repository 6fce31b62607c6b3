#pragma once

#include "core/instant.hpp"

#include <cstdint>

namespace kairos {
inline namespace core {

class Archive;

/// Whether the impacts of a body accumulate: infinitely many in a finite time (Zeno), which no
/// number of events gets past. Two signs of it, both counted rather than proven.
class ImpactHistory {
 public:
  /// An impact at t left the body with this speed (m/s, the fastest of its points). True where more
  /// than 200 impacts in a row followed each other without it moving as far as `reach`, m. A cradle
  /// or the break of a rack has a few.
  [[nodiscard]] bool creeps(double speed, double reach, Instant t);

  /// True where impacts follow each other ever faster, as between a wall and a piston that comes
  /// nearer: three times in a row twice as many impacts took less time than half as many before,
  /// and from one to the next it moves less than `reach`, m. Such impacts end where the gap does; a
  /// gap of 1e-9 m would take 1e9 of them. Impacts at a steady rate take twice as long for twice as
  /// many. Not asked of the first 4096. To be asked once an impact, before `creeps`.
  [[nodiscard]] bool accelerates(double reach, Instant t);

  /// A look at a pair that went on by `progress` of its motions (0 to 1): true where more than 200
  /// in a row went on by less than 1e-12, that is, where time stands still.
  [[nodiscard]] bool stalls(double progress);

  void persist(Archive& archive);

 private:
  int creeping_ = 0;  ///< events in a row between which it hardly moved
  Instant last_impact_ = Instant::never();
  double last_speed_ = 0.0;       ///< after that impact, m/s
  std::int64_t impacts_ = 0;      ///< so far
  Instant octave_start_{};        ///< when `impacts_` was last a power of two
  double octave_duration_ = 0.0;  ///< of the doubling before, s
  int accelerating_ = 0;          ///< doublings in a row, each shorter than the one before
};

}  // namespace core
}  // namespace kairos
