#pragma once

#include "core/plain_balls.hpp"
#include "core/schemes/event/event_agenda.hpp"
#include "core/schemes/event/jump_watch.hpp"
#include "core/schemes/event/work_budget.hpp"
#include "core/schemes/shared/scheme_run.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

namespace kairos {
inline namespace core {

/// What a person can do about bodies that stay in touch: the end of a stop's reason.
inline constexpr std::string_view lasting_contact_advice =
    "allowed: shorter frames (--frame), another scheme (--scheme), or a run that ends before "
    "(--duration)";

/// What the parts of an event-driven run share besides what every run has: what is due, how far
/// predictions go, and how much work is left.
///
/// An epoch lasts as long as the scene says that it is of interest. Nothing is predicted beyond its
/// end, so predictions, hence bits, do not depend on when the run is to end.
class EventRun : public SchemeRun {
 public:
  EventRun(const Model& of, const Method& method, const SchemeOptions& asked, Recorder& to)
      : SchemeRun(of, method, asked, to),
        plain_balls(of),
        agenda(of),
        jumps(watches_jumps ? of.size() : 0),
        budget_(asked.max_events, of.size(), mean_frame),
        // Not shorter than some frames, so that epochs cost nothing.
        epoch_(std::max(of.scene().duration, 64.0 * mean_frame)) {}

  /// Ends the run at t, for the first reason given.
  void stop(Instant t, std::string why) {
    if (!stopped()) {
      stopped_at_ = t;
      SchemeRun::stop(std::move(why));
    }
  }
  /// When the run stopped; of no meaning before.
  [[nodiscard]] Instant stopped_at() const { return stopped_at_; }

  /// A frame begins, and with it the count of its events.
  void begin_frame() { budget_.begin_frame(); }
  /// Counts an event that is taken; stops the run where they never end.
  void spend(const DueEvent& event);

  /// An epoch begins at t; that it ends is put on the agenda.
  void begin_epoch(Instant t);
  /// How long an epoch lasts, s.
  [[nodiscard]] double epoch() const { return epoch_; }
  /// When the current one ends.
  [[nodiscard]] Instant epoch_end() const { return epoch_end_; }
  /// Puts on the agenda what is due at t, between a and b; not if the epoch ends before: whoever
  /// asks is asked again then.
  void push_in_epoch(Instant t, DueKind kind, BodyIndex a, BodyIndex b) {
    if (t < epoch_end_) {
      agenda.push(t, kind, a, b);
    }
  }

  /// Saves or restores what changes during a run.
  void persist(Archive& archive);

  const PlainBalls plain_balls;
  Agenda agenda;
  JumpWatch jumps;  ///< of no body unless `watches_jumps`

 private:
  WorkBudget budget_;
  double epoch_;  ///< s
  Instant epoch_end_;
  Instant stopped_at_;
};

}  // namespace core
}  // namespace kairos
