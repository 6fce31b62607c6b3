#pragma once

#include "core/model.hpp"

#include <cstdint>
#include <tuple>
#include <vector>

namespace kairos {
inline namespace core {

class Archive;

/// What is due, in the order in which simultaneous events are taken.
enum class Due : std::uint8_t {
  epoch_end,       ///< what was predicted ends here, for all
  segment_end,     ///< the motion of `a` ends there; the next one is due
  support_ends,    ///< `a` leaves the surface `b`
  mode_ends,       ///< the patch of `a` and `b` no longer carries what it carries
  contact_begins,  ///< the bounces of `a` on `b` have died down: told, nothing changes
  field_entered,   ///< between `a` and `b`
  field_left,
  clear_of_hand,  ///< what a hand has let go of is clear of it
  horizon,        ///< pairs of `a` have been predicted up to here
  recheck,        ///< ask the detector again
  stays,          ///< two solids touch, and would go on to do so
  impact,
};
constexpr Due last_of(Due) { return Due::impact; }

/// An event that has come up.
struct DueEvent {
  Instant time;
  Due due = Due::impact;
  BodyIndex a = 0;
  BodyIndex b = 0;
  double patience = 0.0;  ///< impact: t_hi - t_lo, s
  bool decided = true;    ///< impact: contact by t_hi is proven
  bool stale = false;     ///< one of the two has moved otherwise since it was predicted
};

/// What is due, earliest first: a binary heap. Bodies go by their rank in alphabetical order, so
/// that neither the order of simultaneous events nor any query depends on the order in which a file
/// lists them.
class Agenda {
 public:
  explicit Agenda(const Model& model);

  [[nodiscard]] bool due_before(Instant t) const {
    return !heap_.empty() && heap_.front().time < t;
  }
  void push(Instant t, Due due, BodyIndex a, BodyIndex b, double patience = 0.0,
            bool decided = true);
  [[nodiscard]] DueEvent pop();
  /// Body i has a new motion: all that was predicted of it is stale. Recognised when it comes up.
  void renew(BodyIndex i) { ++version_[i]; }

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
    Due due = Due::impact;
    std::uint32_t a = 0;  ///< ranks
    std::uint32_t b = 0;
    std::uint32_t version_a = 0;  ///< of the motions for which it was predicted
    std::uint32_t version_b = 0;
    double patience = 0.0;
    bool decided = true;

    void persist(Archive& archive);
    [[nodiscard]] auto key() const { return std::tuple(time.seconds, time.correction, due, a, b); }
  };
  [[nodiscard]] bool stale(const Entry& entry) const {
    return entry.version_a != version_[by_name_[entry.a]] ||
           entry.version_b != version_[by_name_[entry.b]];
  }

  void sweep_out();
  static bool later(const Entry& x, const Entry& y) { return x.key() > y.key(); }

  std::vector<BodyIndex> by_name_;
  std::vector<std::uint32_t> rank_;
  std::vector<std::uint32_t> version_;
  std::vector<Entry> heap_;
  std::size_t crowded_ = least_crowded;  ///< size at which stale entries are swept out
};

}  // namespace core
}  // namespace kairos
