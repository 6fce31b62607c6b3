#pragma once

#include "core/scheme.hpp"
#include "core/schemes/energy_account.hpp"
#include "core/schemes/event_agenda.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace kairos {
inline namespace core {

/// What the parts of an event-driven run share: what was asked for, what is due, what has been
/// counted, and whether it is over.
struct EventRun {
  EventRun(const Model& of, const Method& method, const SchemeOptions& asked, Recorder& to)
      : model(of),
        detector(*method.detector),
        law(*method.law),
        options(asked),
        recorder(to),
        wants_motions(to.wants_motions()),
        agenda(of),
        account(of, ledger),
        // Not shorter than some frames, so that epochs cost nothing.
        epoch(std::max(of.scene().duration, 64.0 * mean_frame_duration(asked.frames))) {}

  /// Ends the run at t, for the first reason given.
  void stop(Instant t, std::string why) {
    if (reason.empty()) {
      reason = std::move(why);
      stopped_at = t;
    }
  }
  [[nodiscard]] bool stopped() const { return !reason.empty(); }
  /// "'a' and 'b'".
  [[nodiscard]] std::string names(BodyIndex a, BodyIndex b) const {
    return "'" + model.body(a).name + "' and '" + model.body(b).name + "'";
  }

  const Model& model;
  const ContactDetector& detector;
  const ImpactLaw& law;
  const SchemeOptions options;
  Recorder& recorder;
  const bool wants_motions;

  Agenda agenda;
  EnergyLedger ledger;
  EnergyAccount account;  ///< keeps the ledger
  Cost cost;
  Instant time;  ///< of the last event or frame
  /// Nothing is predicted beyond the end of the epoch, which lasts as long as the scene says that
  /// it is of interest: predictions, hence bits, do not depend on when the run is to end.
  const double epoch;  ///< s
  Instant epoch_end;
  std::string reason;  ///< of a stop
  Instant stopped_at;
};

}  // namespace core
}  // namespace kairos
