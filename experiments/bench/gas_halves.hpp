#pragma once

#include "core/recorder.hpp"

#include <cstdint>

namespace kairos::experiments {

/// What two cores could do with one run, at best: each takes half of the room, and works through
/// its impacts until the next that is between the halves. Optimistic: that one is taken for known
/// beforehand, balls that change halves cost nothing, and neither waits for memory. (Domains with
/// certified horizons: Lubachevsky, J. Comput. Phys. 94, 1991; Miller & Luding, J. Comput. Phys.
/// 193, 2004.)
class GasHalves : public Recorder {
 public:
  void event(const Event& event) override;

  /// Impacts between the halves.
  [[nodiscard]] std::int64_t across() const { return across_; }
  [[nodiscard]] std::int64_t impacts() const { return impacts_; }
  /// How many times as fast, where an impact takes `impact` and handing over to the other core and
  /// back takes `hand_over`, both s.
  [[nodiscard]] double speedup(double impact, double hand_over) const;

 private:
  std::int64_t impacts_ = 0;
  std::int64_t across_ = 0;
  std::int64_t one_after_another_ = 0;  ///< impacts of the slower half, summed, and those across
  std::int64_t left_ = 0;               ///< since the last one across
  std::int64_t right_ = 0;
};

/// What it takes to hand over to another core and back, s: two threads that wait for each other in
/// a loop, the least of several rounds.
[[nodiscard]] double hand_over_seconds();

}  // namespace kairos::experiments
