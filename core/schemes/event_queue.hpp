#pragma once

#include "core/instant.hpp"

#include <algorithm>
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
  contact_begins,  ///< the bounces of `a` on `b` have died down: told, nothing changes
  field_entered,   ///< between `a` and `b`
  field_left,
  clear_of_hand,  ///< what a hand has let go of is clear of it
  horizon,        ///< pairs of `a` have been predicted up to here
  recheck,        ///< ask the detector again
  impact,
};

/// An entry of the queue. Bodies go by their rank in alphabetical order, `a` before `b`, so that
/// neither the queue nor any query depends on the order in which a file lists them.
struct QueuedEvent {
  Instant time;
  Due due = Due::impact;
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t version_a = 0;  ///< of the motions for which it was predicted
  std::uint32_t version_b = 0;
  double patience = 0.0;  ///< impact: t_hi - t_lo, s
  bool decided = true;    ///< impact: contact by t_hi is proven

  void persist(Archive& archive);

  [[nodiscard]] auto key() const { return std::tuple(time.seconds, time.correction, due, a, b); }
};

/// Binary heap of events, earliest first. Entries whose versions have passed are stale: they are
/// recognised when they come up.
class EventQueue {
 public:
  [[nodiscard]] bool empty() const { return heap_.empty(); }
  [[nodiscard]] const QueuedEvent& top() const { return heap_.front(); }
  void push(const QueuedEvent& event) {
    heap_.push_back(event);
    std::push_heap(heap_.begin(), heap_.end(), later);
  }
  void persist(Archive& archive);
  QueuedEvent pop() {
    std::pop_heap(heap_.begin(), heap_.end(), later);
    const QueuedEvent event = heap_.back();
    heap_.pop_back();
    return event;
  }

 private:
  static bool later(const QueuedEvent& x, const QueuedEvent& y) { return x.key() > y.key(); }

  std::vector<QueuedEvent> heap_;
};

}  // namespace core
}  // namespace kairos
