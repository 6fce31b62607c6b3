#pragma once

#include "core/schemes/frame/frame_contacts.hpp"
#include "core/schemes/frame/frame_hands.hpp"
#include "core/schemes/frame/frame_motions.hpp"
#include "core/schemes/shared/frame_clock.hpp"
#include "core/schemes/shared/grasps.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace kairos {
inline namespace core {

/// The world of the schemes that look at it at given times: bodies, their steppers, the forces they
/// were given, and the clock of rendered frames. Each scheme is a loop over these operations.
///
/// A *proposal* is where everything would go without contacts; its times are seconds from now. A
/// scheme accepts a part of it, or bends it at a contact.
class FrameWorld {
 public:
  FrameWorld(const Model& model, const Method& method, const SchemeOptions& options,
             Recorder& recorder);

  /// Draws the world as it is; false when the run is over (its last frame has then been drawn).
  bool draw();
  /// Duration of the frame that was drawn last, s; the run's last frame may be cut short.
  [[nodiscard]] double frame_duration() const { return clock_.frame(); }

  /// Everything moves for h (13.3, 13.4): forces act, given forces are then forgotten.
  void advance(double h);

  /// Computes where everything would be until h from now.
  void propose(double h);
  /// Largest displacement of a body's origin over the proposal, m.
  [[nodiscard]] double largest_movement() const;
  /// The first s of the proposal, 0 < s <= h, come true; given forces are then forgotten.
  void accept(double s);
  /// At s of the proposal the two meet: handles them there and recomputes the rest of the proposal
  /// for the islands they belong to.
  void bend(BodyIndex a, BodyIndex b, double s);
  /// When the two first meet within [0, s] of the proposal, of which what is before the last bend
  /// of either is settled: what has been told and booked there is not undone.
  [[nodiscard]] TimeOfImpact time_of_impact(BodyIndex a, BodyIndex b, double s);
  /// Do the boxes that the two sweep over the proposal, as far as it is open, overlap (fig. 14)?
  [[nodiscard]] bool swept_overlap(BodyIndex a, BodyIndex b);
  /// Would the two overlap at s of the proposal?
  [[nodiscard]] bool overlap_at(BodyIndex a, BodyIndex b, double s);

  /// Do the two overlap now, and is neither of them in a hand?
  [[nodiscard]] bool overlap(BodyIndex a, BodyIndex b) {
    return !grasps_.involve(a, b) && run_.touch(a, b);
  }
  /// 13.5: the two exchange now what their entities and the impact law say.
  void handle(BodyIndex a, BodyIndex b) {
    contacts_.handle(a, b, run_.bodies[a], run_.bodies[b], run_.time);
  }

  /// Ends the run before its time.
  void stop(std::string reason) { run_.stop(std::move(reason)); }
  void trace(Stage stage, double fraction) { run_.recorder.stage(stage, fraction); }

  [[nodiscard]] const Model& model() const { return run_.model; }
  [[nodiscard]] std::size_t size() const { return run_.bodies.size(); }
  [[nodiscard]] bool movable(BodyIndex i) const {
    return run_.model.mobility(i) != Mobility::fixed;
  }
  [[nodiscard]] RunResult result() &&;

 private:
  [[nodiscard]] double settled_until(BodyIndex a, BodyIndex b) const {
    return std::max(motions_.bent_at(a), motions_.bent_at(b));
  }
  void persist(Archive& archive);

  FrameRun run_;
  Grasps grasps_;
  FrameMotions motions_;
  FrameContacts contacts_;
  FrameHands hands_;
  FrameClock clock_;
  bool resumed_ = false;  ///< this frame was drawn before the run was interrupted
};

/// 13.1, literally: every `current` with every `next` after it, in the order of creation; the first
/// overlap is handled and ends the search of this `current`, unless `next` was the last `next`
/// handled in this pass. Returns how many pairs were handled.
int detect_and_handle(FrameWorld& world);

/// Lets every field push what overlaps it now, until the next step.
void give_field_forces(FrameWorld& world);

}  // namespace core
}  // namespace kairos
