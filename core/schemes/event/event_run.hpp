#pragma once

#include "core/schemes/event/event_agenda.hpp"
#include "core/schemes/event/work_budget.hpp"
#include "core/schemes/shared/scheme_run.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

namespace kairos {
inline namespace core {

/// What a person can do about bodies that stay in touch: the end of a stop's reason.
inline constexpr std::string_view part_them =
    "contact that lasts is kept where loads are constant and nothing turns, or one body alone "
    "turns on what is fixed; allowed: bodies that start apart, a restitution of 1, another scheme, "
    "or a run that ends before (--duration)";

/// What the parts of an event-driven run share: also what is due, and how far predictions go.
struct EventRun : SchemeRun {
  EventRun(const Model& of, const Method& method, const SchemeOptions& asked, Recorder& to)
      : SchemeRun(of, method, asked, to),
        agenda(of),
        budget(asked.max_events, of.size(), mean_frame),
        // Not shorter than some frames, so that epochs cost nothing.
        epoch(std::max(of.scene().duration, 64.0 * mean_frame)) {}

  void stop(Instant t, std::string why) {
    if (!stopped()) {
      stopped_at = t;
      SchemeRun::stop(std::move(why));
    }
  }

  /// Counts an event that is taken; stops the run where they never end.
  void spend(const DueEvent& event);

  Agenda agenda;
  WorkBudget budget;
  /// Nothing is predicted beyond the end of the epoch, which lasts as long as the scene says that
  /// it is of interest: predictions, hence bits, do not depend on when the run is to end.
  const double epoch;  ///< s
  Instant epoch_end;
  Instant stopped_at;
};

}  // namespace core
}  // namespace kairos
