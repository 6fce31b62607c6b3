#pragma once

#include "core/instant.hpp"
#include "core/state.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

/// Whether this build asks a `JumpWatch`: where asserts are armed.
#ifdef NDEBUG
constexpr bool watches_jumps = false;
#else
constexpr bool watches_jumps = true;
#endif

/// Holds the parts of an event-driven run to the protocol of a jump. The state of a body jumps in
/// five steps: its island is booked, the body is brought, its state is changed, it is launched, and
/// what it meets is predicted. A step that is left out gives a wrong ledger, a wrong motion or a
/// contact that nobody asks about, and no error. This finds it, body by body and event by event.
/// Only builds with asserts ask it.
class JumpWatch {
 public:
  explicit JumpWatch(std::size_t bodies) : bodies_(bodies) {}

  /// The state of body i at t is where events change it.
  void brought(BodyIndex i, Instant t, const BodyState& state) {
    note(i).brought = t;
    bodies_[i].state = state;
    bodies_[i].launched = false;
  }
  [[nodiscard]] bool is_brought(BodyIndex i, Instant t) const { return bodies_[i].brought == t; }
  /// Body i has a new motion. `predicts`: what it meets on it must be predicted; false of what a
  /// hand carries, which meets nothing.
  void launched(BodyIndex i, bool predicts = true) {
    note(i).launched = true;
    bodies_[i].unpredicted = predicts;
  }
  /// What body i meets on its motion has been asked.
  void predicted(BodyIndex i) { bodies_[i].unpredicted = false; }

  /// An event is over: what it left out of a jump, or nothing. `now`: the states as it has changed
  /// them.
  [[nodiscard]] std::string_view left_out(const State& now) const {
    for (const BodyIndex i : touched_) {
      if (bodies_[i].unpredicted) {
        return "a body was launched, and what it meets was not predicted";
      }
      if (!bodies_[i].launched && !same(bodies_[i].state, now[i])) {
        return "the state of a body was changed, and it was not launched from there";
      }
    }
    return {};
  }
  /// The next event begins.
  void begin() {
    for (const BodyIndex i : touched_) {
      bodies_[i].touched = false;
    }
    touched_.clear();
  }

 private:
  struct Watched {
    Instant brought;
    BodyState state;
    bool launched = false;  ///< since it was brought
    bool unpredicted = false;
    bool touched = false;
  };
  Watched& note(BodyIndex i) {
    if (!bodies_[i].touched) {
      bodies_[i].touched = true;
      touched_.push_back(i);
    }
    return bodies_[i];
  }
  static bool same(const BodyState& x, const BodyState& y) {
    return x.pose.position == y.pose.position &&
           x.pose.orientation.coeffs() == y.pose.orientation.coeffs() &&
           x.twist.linear == y.twist.linear && x.twist.angular == y.twist.angular;
  }

  std::vector<Watched> bodies_;
  std::vector<BodyIndex> touched_;  ///< in this event
};

}  // namespace core
}  // namespace kairos
