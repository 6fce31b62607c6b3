#pragma once

#include "core/schemes/event/event_agenda.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace kairos {
inline namespace core {

/// Bounds the work of an event-driven run, whatever its cause: no run is endless.
///
/// Two bounds on the events that are taken, both counted and neither of them a proof:
/// - at one *instant*, as long as time has not passed by more than double precision resolves
///   (eps of the time, or of a frame where that is more): 10,000, or 1000 a body where that is
///   more. Balls that touch hand an impact on in one instant; each of them a few times.
/// - in one *frame*: `most_in_frame`.
/// Crossings have the same bounds, and are counted by themselves: how many there are depends on how
/// neighbours are found, and where a run stops must not.
class WorkBudget {
 public:
  enum class Spent { nothing, instant, frame };

  /// `most_in_frame`: 0 takes the default, 1,000,000, or 1000 a body where that is more. `frame`:
  /// how long frames last on average, s.
  WorkBudget(std::int64_t most_in_frame, std::size_t bodies, double frame);

  void begin_frame() {
    for (Count& count : counts_) {
      count.in_frame = 0;
    }
  }
  /// Counts an event; tells which bound it exceeds.
  [[nodiscard]] Spent spend(const DueEvent& event);

  /// Of the kind that was counted last, in this frame.
  [[nodiscard]] std::int64_t in_frame() const { return counts_[last_].in_frame; }
  [[nodiscard]] std::int64_t most_in_frame() const { return most_in_frame_; }
  [[nodiscard]] std::int64_t most_at_once() const { return most_at_once_; }

  /// A pair and its share of the latest events.
  struct Share {
    BodyIndex a = 0;
    BodyIndex b = 0;
    double share = 0.0;
  };
  /// The pairs of the latest events (crossings, if there were too many of these), the busiest
  /// first; pairs with less than a tenth are left out.
  [[nodiscard]] std::vector<Share> busiest() const;

  void persist(Archive& archive);

 private:
  static constexpr std::size_t remembered = 256;
  struct Pair {
    BodyIndex a = 0;
    BodyIndex b = 0;
    void persist(Archive& archive);
  };

  std::int64_t most_in_frame_;
  std::int64_t most_at_once_;
  double frame_;  ///< s
  struct Count {
    std::int64_t in_frame = 0;
    std::int64_t at_once = 0;
    Instant since;                          ///< the instant that lasts
    std::array<Pair, remembered> latest{};  ///< a ring
    std::uint64_t taken = 0;
    void persist(Archive& archive);
  };
  std::array<Count, 2> counts_{};  ///< of crossings second
  std::size_t last_ = 0;           ///< of which the last one was
};

}  // namespace core
}  // namespace kairos
