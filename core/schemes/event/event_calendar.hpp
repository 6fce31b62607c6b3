#pragma once

#include "core/instant.hpp"
#include "core/state.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace kairos {
inline namespace core {

/// Which body is due next: a calendar queue [Brown1988] of one entry a body.
///
/// Days hold some eight entries each, in the order in which they were made; those of today are
/// sorted when it begins, and what is put later that day, which is rare, is in a heap. What is due
/// in another week is sorted by days when that begins: weeks are so few that where each of them
/// ends stays in the cache, days are not. An entry is put off by making another: older ones of the
/// body are passed over. Entries at the same instant come in the order of their keys. What a
/// calendar costs does not depend on how many bodies there are; the length of its days adapts. Who
/// is due when is not kept here: a *source* tells it again when the day comes.
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
  /// Remembers what was put.
  class Source {
   public:
    /// As it was put last; its stamp means nothing.
    [[nodiscard]] virtual Entry due(std::uint32_t body) const = 0;
    /// That is about to be asked for.
    virtual void look_up(std::uint32_t /*body*/) const {}

   protected:
    ~Source() = default;
  };

  explicit EventCalendar(std::size_t bodies) : latest_(bodies, 0) {}

  /// From now on a body is due then, as the source tells it; never: not at all.
  void put(std::uint32_t body, Instant time, const Source& source);
  /// It is not due any more.
  void drop(std::uint32_t body) { ++latest_[body]; }
  /// The earliest; null: nobody is due. Valid until the next `put`.
  [[nodiscard]] const Entry* first(const Source& source) {
    const Entry* const earliest = first_of_today();
    return earliest != nullptr ? earliest : first_after_today(source);
  }
  /// Who is due today and was when it began, and some who were, the earliest last.
  [[nodiscard]] std::span<const Entry> today() const { return today_; }
  /// How many days have begun.
  [[nodiscard]] std::uint64_t days_begun() const { return days_begun_; }

 private:
  /// An entry that is not today's: what it says is the latest of its body, if that has its stamp.
  struct Slip {
    std::uint32_t body = 0;
    std::uint32_t stamp = 0;
    std::uint32_t day = 0;  ///< of its week, if it is filed
  };
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  /// Some slips of a day or of a week, and where more of them are: two lines of the cache. Those
  /// that are over leave theirs to others.
  struct alignas(64) Page {
    std::array<Slip, 10> slips{};
    std::uint32_t count = 0;
    std::uint32_t next = none;
  };

  static bool later(const Entry& x, const Entry& y) {
    if (x.time.seconds != y.time.seconds) {
      return x.time.seconds > y.time.seconds;
    }
    return std::tuple(x.time.correction, x.key, x.key2) >
           std::tuple(y.time.correction, y.key, y.key2);
  }
  template <typename EntryOrSlip>
  [[nodiscard]] bool current(const EntryOrSlip& entry) const {
    return entry.stamp == latest_[entry.body];
  }
  [[nodiscard]] Entry entry_of(const Source& source, const Slip& slip) const;
  void file(const Slip& slip, Instant time, const Source& source);
  void note(std::uint32_t& in, const Slip& slip);
  template <typename See>
  void tear_off(std::uint32_t& from, const See& see);
  /// The earliest of today's; null: none is left. Those that are over are taken off.
  [[nodiscard]] const Entry* first_of_today() {
    while (!today_.empty() && !current(today_.back())) {
      today_.pop_back();
    }
    if (late_.empty()) {
      return today_.empty() ? nullptr : &today_.back();
    }
    return first_of_late();
  }
  [[nodiscard]] const Entry* first_of_late();
  [[nodiscard]] const Entry* first_after_today(const Source& source);
  [[nodiscard]] std::size_t days_ahead() const { return weeks_.size() * days_.size(); }
  void begin_week(std::int64_t week);
  void file_far(const Source& source);
  void begin_next_day(const Source& source);
  void look_ahead(const Source& source) const;
  void renew(const Source& source);

  std::vector<std::uint32_t> latest_;  ///< stamps, by body
  std::vector<Entry> today_;           ///< the earliest last
  std::vector<Entry> late_;            ///< today's, too: a heap, the earliest first
  std::vector<std::uint32_t> days_;    ///< of this week: the first page of each; or none
  std::vector<std::uint32_t> weeks_;   ///< the next ones, a ring: the same
  std::vector<Page> pages_;
  std::uint32_t free_ = none;  ///< a page that nobody needs, and so on
  std::vector<Slip> far_;      ///< beyond those weeks
  std::size_t filed_ = 0;      ///< in `days_` and `weeks_`
  std::int64_t day_ = 0;       ///< today's number
  std::int64_t week_ = 0;      ///< this week's
  int to_week_ = 0;            ///< a week has two to the power of this days
  std::uint64_t days_begun_ = 0;
  std::int64_t check_ = 0;  ///< the day on which `far_` is looked through again
  std::size_t taken_ = 0;   ///< entries that became today's since the last such day
  double origin_ = 0.0;     ///< when day 0 began, s
  double per_day_ = 0.0;    ///< 1 / length of a day, 1/s; 0: nothing is filed by days yet
};

}  // namespace core
}  // namespace kairos
