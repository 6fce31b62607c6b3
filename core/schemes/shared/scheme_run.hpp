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
class SchemeRun {
 public:
  SchemeRun(const Model& of, const Method& method, const SchemeOptions& asked, Recorder& to);

  /// Ends the run before its time, for the first reason given.
  void stop(std::string why) {
    if (why_stopped_.empty()) {
      why_stopped_ = std::move(why);
    }
  }
  [[nodiscard]] bool stopped() const { return !why_stopped_.empty(); }
  /// "'a' and 'b'".
  [[nodiscard]] std::string names(BodyIndex a, BodyIndex b) const {
    return "'" + model.body(a).name + "' and '" + model.body(b).name + "'";
  }

  /// Asks the impact law what happens at the event, whose time and contact are set: the states of
  /// the two bodies become those after it, and what it pushes is added to the net forces (N). The
  /// event is counted and told. The energies that are returned are not in the ledger yet: the
  /// caller knows on which lines they belong. `flat`: the impact turns spheres only.
  ImpactEnergy exchange(Event& event, BodyState& a, BodyState& b, Vector3& force_a,
                        Vector3& force_b, bool flat = false);
  /// Two plain balls, or one and what is fixed (null), have struck each other, as the event says,
  /// which is counted and told.
  void struck(const Event& event, const PlainBall* a, const PlainBall* b);
  /// Inertia of body i in an impact that turns spheres only.
  [[nodiscard]] BodyInertia flat_inertia(BodyIndex i) const;
  /// Offset from where a body is computed to where it is recorded, m: in a periodic box it is
  /// computed as the image that meets others, and recorded along its own path without jumps.
  [[nodiscard]] Vector3 recorded_offset(BodyIndex i) const {
    return boxes_crossed.empty() ? Vector3(Vector3::Zero())
                                 : model.scene().periodic->shift(boxes_crossed[i]);
  }
  /// An event at which no state jumps.
  void note(const Event& event);
  /// Events that are found out of order are kept from here on, until they are told in order.
  void hold_events() { holds_events_ = true; }
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
  EnergyLedger ledger;
  EnergyAccount account;  ///< keeps the ledger
  Cost cost;
  std::vector<Image> boxes_crossed;  ///< by body; empty where no box is periodic

 private:
  void tell(const Event& event);
  [[nodiscard]] Event as_recorded(Event event) const;

  std::string why_stopped_;
  bool holds_events_ = false;
  std::vector<Event> held_events_;  ///< not told yet
};

}  // namespace core
}  // namespace kairos
