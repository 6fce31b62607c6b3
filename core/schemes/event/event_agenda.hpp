#pragma once

#include "core/model.hpp"
#include "core/periodic_box.hpp"
#include "core/prefetch.hpp"
#include "core/schemes/event/event_calendar.hpp"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {

class Archive;

/// What is due, in the order in which simultaneous events are taken.
enum class DueKind : std::uint8_t {
  epoch_end,       ///< what was predicted ends here, for all
  segment_end,     ///< the motion of `a` ends there; the next one is due
  support_ends,    ///< `a` leaves the surface `b`
  mode_ends,       ///< the patch of `a` and `b` no longer carries what it carries
  contact_begins,  ///< the bounces of `a` on `b` have died down: told, nothing changes
  field_entered,   ///< between `a` and `b`
  field_left,
  clear_of_hand,  ///< what a hand has let go of is clear of it
  crossing,       ///< `a` comes near others
  recheck,        ///< ask the detector again
  stays,          ///< two solids touch, and would go on to do so
  impact,
  step_ends,  ///< the motions of what `a` and `b` hold together were found up to here
};
constexpr DueKind last_of(DueKind) { return DueKind::step_ends; }

/// An event that has come up.
struct DueEvent {
  Instant time;
  DueKind kind = DueKind::impact;
  BodyIndex a = 0;
  BodyIndex b = 0;
  double bracket = 0.0;  ///< impact: t_hi - t_lo, s
  bool decided = true;   ///< impact: contact by t_hi is proven
  bool stale = false;    ///< one of the two has moved otherwise since it was predicted
  bool own = false;      ///< the earliest meeting of `owner`: it knows of no later one
  BodyIndex owner = 0;
  Image image{};  ///< recheck: of b, as a sees it
};

/// What is due, earliest first. Bodies go by their rank in alphabetical order, so that neither the
/// order of simultaneous events nor any query depends on the order in which a file lists them.
///
/// What is predicted lies in a binary heap until it comes up. Bodies that are cheap to ask about
/// have one record each instead, of their earliest meeting and of when they come near others: when
/// a record comes up and is stale, its body is asked about again.
class Agenda : private EventCalendar::Source {
 public:
  explicit Agenda(const Model& model);

  [[nodiscard]] bool due_before(Instant t) {
    const EventCalendar::Entry* const first = calendar_.first(*this);
    return (!heap_.empty() && heap_.front().time < t) || (first != nullptr && first->time < t);
  }
  void push(Instant t, DueKind kind, BodyIndex a, BodyIndex b, double bracket = 0.0,
            bool decided = true, const Image& image = {});
  [[nodiscard]] DueEvent pop();
  /// Body i has a new motion: all that was predicted of it is stale. Recognised when it comes up.
  void renew(BodyIndex i) { ++version_[i]; }

  /// Shows the bodies of what will come up soon, as far as the calendar tells: two at a time, which
  /// may be the same.
  template <typename See>
  void see_soon(const See& see) const {
    const std::span<const EventCalendar::Entry> today = calendar_.today();
    for (std::size_t k = 2; k < std::min<std::size_t>(today.size() + 1, 4); ++k) {
      show(today[today.size() - k], see);
    }
  }
  /// The same of all that comes up on the day that has begun since this was last asked.
  template <typename See>
  void see_day(const See& see) {
    if (calendar_.days_begun() != seen_day_) {
      seen_day_ = calendar_.days_begun();
      for (const EventCalendar::Entry& entry : calendar_.today()) {
        show(entry, see);
      }
    }
  }
  /// What is known of body i is about to be asked for.
  void look_up(std::uint32_t i) const override { prefetch(records_[i]); }

  /// Body i meets b then; kept if it is the earliest that is known of i.
  void meet(BodyIndex i, BodyIndex b, Instant t, double bracket);
  /// The earliest meeting of i that is known, if nobody has moved otherwise; never: none is.
  [[nodiscard]] Instant meeting(BodyIndex i) const;
  /// Nothing is known of i's meetings.
  void forget_meeting(BodyIndex i) { records_[i].meeting = Instant::never(); }
  void cross(BodyIndex i, Instant t) { records_[i].crossing = t; }
  /// After changes of i's record. What comes up of it is not filed any more.
  void file(BodyIndex i);
  [[nodiscard]] bool is_filed(BodyIndex i) const { return records_[i].filed; }
  /// How often body i has got a new motion.
  [[nodiscard]] std::uint32_t version(BodyIndex i) const { return version_[i]; }

  /// Bodies in the order of their names.
  [[nodiscard]] const std::vector<BodyIndex>& by_name() const { return by_name_; }
  /// The place of each body there.
  [[nodiscard]] const std::vector<std::uint32_t>& ranks() const { return rank_; }
  /// Whether a comes before b there.
  [[nodiscard]] bool before(BodyIndex a, BodyIndex b) const { return rank_[a] < rank_[b]; }

  /// How many are due, stale ones included: never more than twice what is not, and some.
  [[nodiscard]] std::size_t size() const { return heap_.size(); }

  /// The heap as it lies: what is due at the same instant keeps its order.
  void persist(Archive& archive);

 private:
  static constexpr std::size_t least_crowded = 1024;
  struct Entry {
    Instant time;
    double bracket = 0.0;
    std::uint32_t a = 0;  ///< ranks
    std::uint32_t b = 0;
    std::uint32_t version_a = 0;  ///< of the motions for which it was predicted
    std::uint32_t version_b = 0;
    Image image{};
    DueKind kind = DueKind::impact;
    bool decided = true;

    void persist(Archive& archive);
    /// As that of an entry of the calendar.
    [[nodiscard]] auto full_key() const {
      const std::uint64_t first = static_cast<std::uint64_t>(kind) << 32U | a;
      return std::tuple(time.seconds, time.correction, first, std::uint64_t{b});
    }
    [[nodiscard]] auto key() const { return std::tuple(time.seconds, time.correction, kind, a, b); }
  };
  [[nodiscard]] bool stale(const Entry& entry) const {
    return entry.version_a != version_[by_name_[entry.a]] ||
           entry.version_b != version_[by_name_[entry.b]];
  }

  /// What is known of a body without the heap.
  struct Record {
    Instant meeting = Instant::never();
    Instant crossing = Instant::never();
    double bracket = 0.0;
    std::uint32_t partner = 0;  ///< ranks and versions as in `Entry`
    std::uint32_t version = 0;
    std::uint32_t partner_version = 0;
    bool filed = false;

    void persist(Archive& archive);
  };
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> ranks(BodyIndex i,
                                                              std::uint32_t other) const {
    return std::minmax(rank_[i], other);
  }
  /// What comes up first of its record, if nothing has changed since it was filed.
  [[nodiscard]] EventCalendar::Entry due(std::uint32_t body) const override;
  template <typename See>
  void show(const EventCalendar::Entry& entry, const See& see) const {
    const auto rank = [](std::uint64_t key) { return static_cast<std::uint32_t>(key); };
    see(by_name_[rank(entry.key)], by_name_[rank(entry.key2)]);
  }
  [[nodiscard]] DueEvent pop_record(const EventCalendar::Entry& first);

  void sweep_out();
  static bool later(const Entry& x, const Entry& y) { return x.key() > y.key(); }

  std::vector<BodyIndex> by_name_;
  std::vector<std::uint32_t> rank_;
  std::vector<std::uint32_t> version_;
  std::vector<Entry> heap_;
  std::vector<Record> records_;
  EventCalendar calendar_;
  std::uint64_t seen_day_ = 0;
  std::size_t crowded_ = least_crowded;  ///< size at which stale entries are swept out
};

}  // namespace core
}  // namespace kairos
