#pragma once

#include "core/archive.hpp"
#include "core/scheme.hpp"
#include "core/schemes/shared/energy_account.hpp"

#include <string>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {

/// What the parts of a run share, whatever its scheme: what was asked for, what has been counted
/// and booked, and whether it is over.
struct SchemeRun {
  SchemeRun(const Model& of, const Method& method, const SchemeOptions& asked, Recorder& to);

  /// Ends the run before its time, for the first reason given.
  void stop(std::string why) {
    if (reason.empty()) {
      reason = std::move(why);
    }
  }
  [[nodiscard]] bool stopped() const { return !reason.empty(); }
  /// "'a' and 'b'".
  [[nodiscard]] std::string names(BodyIndex a, BodyIndex b) const {
    return "'" + model.body(a).name + "' and '" + model.body(b).name + "'";
  }

  /// The impact law changes the states (and adds to the net forces, N) of the two bodies of the
  /// event, whose time and contact are set; counted and told. To book the answer is left to who
  /// knows what of it is the impact's. `flat`: it turns nothing but spheres.
  ImpactEnergy exchange(Event& event, BodyState& a, BodyState& b, Vector3& force_a,
                        Vector3& force_b, bool flat = false);
  /// Inertia of body i as an impact sees it that turns nothing but spheres.
  [[nodiscard]] BodyInertia flat_inertia(BodyIndex i) const;
  /// From where a body is computed to where it is told, m: in a periodic box it is counted on as
  /// whichever image meets others, and told along its own way, without jumps.
  [[nodiscard]] Vector3 way_told(BodyIndex i) const {
    return boxes_on.empty() ? Vector3(Vector3::Zero()) : model.scene().periodic->shift(boxes_on[i]);
  }
  /// An event at which no state jumps.
  void note(const Event& event);
  /// Events that are found out of order are kept from here on, until they are told in order.
  void hold_events() { holds_events = true; }
  void tell_held_events();
  /// Hands what `write` puts into an archive to the keeper of checkpoints, if it wants one now;
  /// `last`: no other offer comes.
  template <typename Write>
  void offer_checkpoint(bool last, const Write& write) {
    if (options.keeper != nullptr && options.keeper->wants(time, last)) {
      Archive archive;
      write(archive);
      options.keeper->keep(time, archive.bytes());
    }
  }
  [[nodiscard]] RunResult result(State&& state) &&;

  const Model& model;
  const ContactDetector& detector;
  const ImpactLaw& law;
  const SchemeOptions options;
  Recorder& recorder;
  const bool wants_motions;
  const double mean_frame;  ///< s

  Instant time;  ///< of the last frame or event
  std::string reason;
  EnergyLedger ledger;
  EnergyAccount account;  ///< keeps the ledger
  Cost cost;
  std::vector<Image> boxes_on;  ///< by body; empty where no box is periodic
  bool holds_events = false;
  std::vector<Event> held_events;  ///< not told yet

 private:
  void tell(const Event& event);
  [[nodiscard]] Event where_told(Event event) const;
};

}  // namespace core
}  // namespace kairos
