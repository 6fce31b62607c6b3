#pragma once

#include "core/instant.hpp"
#include "core/state.hpp"

#include <cstdint>
#include <vector>

namespace kairos {
inline namespace core {

/// Which body is due next: a calendar queue [Brown1988] of one entry a body.
///
/// Days hold some eight entries each, in the order in which they were made; only those of today are
/// in a heap. An entry is put off by making another: older ones of the body are passed over.
/// Entries at the same instant come in the order of their keys. What a calendar costs does not
/// depend on how many bodies there are; the length of its days adapts.
class EventCalendar {
 public:
  /// When a body is due, and what goes first at the same instant.
  struct Entry {
    Instant time;
    std::uint64_t key = 0;   ///< the lesser one first
    std::uint64_t key2 = 0;  ///< where keys are the same
    std::uint32_t body = 0;
    std::uint32_t stamp = 0;  ///< of the body's latest entry, if this is it
  };

  explicit EventCalendar(std::size_t bodies) : latest_(bodies) {}

  /// From now on body `entry.body` is due then; never: not at all.
  void put(Entry entry);
  /// It is not due any more.
  void drop(std::uint32_t body) { ++latest_[body].stamp; }
  /// The earliest; null: nobody is due. Valid until the next `put`.
  [[nodiscard]] const Entry* first();

 private:
  /// An entry that is not today's: what it says is the latest of its body, if that has its stamp.
  struct Slip {
    std::uint32_t body = 0;
    std::uint32_t stamp = 0;
  };
  using Day = std::vector<Slip>;

  static bool later(const Entry& x, const Entry& y);
  template <typename EntryOrSlip>
  [[nodiscard]] bool current(const EntryOrSlip& entry) const {
    return entry.stamp == latest_[entry.body].stamp;
  }
  void file(const Entry& entry);
  void file_far();
  void begin_next_day();
  void renew();

  std::vector<Entry> latest_;  ///< by body
  std::vector<Entry> today_;   ///< a heap, the earliest first
  std::vector<Day> days_;      ///< the next ones, a ring
  Day far_;                    ///< beyond those
  std::size_t filed_ = 0;      ///< in `days_`
  std::int64_t day_ = 0;       ///< today's number
  std::int64_t check_ = 0;     ///< the day on which `far_` is looked through again
  std::size_t taken_ = 0;      ///< entries that became today's since the last such day
  double origin_ = 0.0;        ///< when day 0 began, s
  double per_day_ = 0.0;       ///< 1 / length of a day, 1/s; 0: nothing is filed by days yet
};

}  // namespace core
}  // namespace kairos
