#pragma once

#include "core/model.hpp"
#include "core/scheme.hpp"
#include "core/schemes/energy_account.hpp"
#include "core/schemes/grasps.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

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
  [[nodiscard]] double frame_duration() const { return frame_; }

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
  /// When the two first meet within [0, s] of the proposal.
  [[nodiscard]] TimeOfImpact time_of_impact(BodyIndex a, BodyIndex b, double s);
  /// Do the boxes that the two sweep over the proposal overlap (fig. 14)?
  [[nodiscard]] bool swept_overlap(BodyIndex a, BodyIndex b);
  /// Would the two overlap at s of the proposal?
  [[nodiscard]] bool overlap_at(BodyIndex a, BodyIndex b, double s);

  /// Do the two overlap now, and is neither of them in a hand?
  [[nodiscard]] bool overlap(BodyIndex a, BodyIndex b) {
    return !grasps_.involve(a, b) && touches(a, b);
  }
  /// 13.5: the two exchange now what their entities and the impact law say.
  void handle(BodyIndex a, BodyIndex b) { collide(a, b, bodies_[a], bodies_[b], now_); }

  /// Ends the run before its time.
  void stop(std::string reason);
  void trace(Stage stage, double fraction) { recorder_.stage(stage, fraction); }

  [[nodiscard]] const Model& model() const { return model_; }
  [[nodiscard]] std::size_t size() const { return bodies_.size(); }
  [[nodiscard]] bool movable(BodyIndex i) const { return movable_[i] != 0; }
  [[nodiscard]] RunResult result() &&;

 private:
  /// An island, its stepper, and how far the ledger has followed it.
  struct Mover {
    Island island;
    std::unique_ptr<Stepper> stepper;
    bool exact = false;
    bool jumped = false;               ///< restart before the next step
    bool carried = false;              ///< a hand holds its body: it has no steps of its own
    std::vector<BodyState> states{};   ///< at the end of what was computed
    std::vector<Motion> motions{};     ///< dense output of the last step
    double last_step = 0.0;            ///< s
    std::vector<BodyState> booked{};   ///< where the ledger is
    std::vector<BodyState> reached{};  ///< scratch: the end of a leg
    std::vector<ReplayedStep> replayed{};
    double booked_until = 0.0;  ///< of the proposal, s

    void persist(Archive& archive);
  };
  /// Something falls into a field or not: seen in the latest detection.
  struct FieldContact {
    BodyIndex field = 0, body = 0;
    bool seen = false;

    void persist(Archive& archive);
  };

  [[nodiscard]] bool touches(BodyIndex a, BodyIndex b) {
    ++cost_.overlap_tests;
    return detector_.overlaps(model_.shape(a), bodies_[a].pose, model_.shape(b), bodies_[b].pose);
  }
  void follow_hands();
  void carry(BodyIndex hand, BodyIndex held, double share);
  void note_grasp(EventKind kind, BodyIndex hand, BodyIndex held);

  void gather(Mover& mover) const;
  void scatter(const Mover& mover);
  void begin_step(Mover& mover, Instant t);
  /// One step of the stepper, from `done` on and at most to `until` (s, from `now_` on); false: it
  /// failed, and the run is stopped. Moves `done` on; its length is
  /// `Mover::last_step`.
  bool step(Mover& mover, double& done, double until);
  void fly(Mover& mover, double from, double to);
  void book_step(Mover& mover, Instant t, double h, bool replayable);
  [[nodiscard]] double replay(Mover& mover, double h);
  void book_path(Mover& mover, double until);
  void settle(BodyIndex i, Instant t, double interval);
  void end_step(double h);
  [[nodiscard]] BodyState on_path(BodyIndex i, double s) const;
  [[nodiscard]] const Motion& path_motion(BodyIndex i, double s) const;
  /// Longest stretch from s on, at most to `until`, on which neither path changes its motion.
  [[nodiscard]] double common_stretch(BodyIndex a, BodyIndex b, double s, double until) const;
  void cut_path(BodyIndex i, double s);

  void collide(BodyIndex a, BodyIndex b, BodyState& state_a, BodyState& state_b, Instant t);
  [[nodiscard]] Contact contact(BodyIndex a, BodyIndex b, const BodyState& state_a,
                                const BodyState& state_b);
  void book_impact(const ImpactEnergy& energy, BodyIndex a, BodyIndex b);
  [[nodiscard]] Motion last_motion(BodyIndex i) const;
  [[nodiscard]] double loss_at_contact(BodyIndex a, BodyIndex b, double loss_when_handled);
  void meet_field(BodyIndex a, BodyIndex b);
  void record_fields_left();
  void check_finite();
  bool open_frame();
  void offer_checkpoint(bool last);
  void persist(Archive& archive);

  const Model& model_;
  const ContactDetector& detector_;
  const ImpactLaw& law_;
  const bool law_needs_contact_;
  const SchemeOptions options_;
  Recorder& recorder_;
  const bool wants_motions_;

  State bodies_;
  State after_;  ///< scratch: where a step ends, while `bodies_` is where it began
  std::vector<char> movable_;
  std::vector<Vector3> given_force_;  ///< net force given in contacts, N
  bool any_given_ = false;
  std::vector<TrackerMemory> trackers_;
  std::vector<BodyIndex> driven_;
  Grasps grasps_;
  std::vector<Mover> movers_;
  std::vector<std::vector<Motion>> paths_;  ///< of the proposal, per body, end to end
  double proposed_ = 0.0;
  double last_step_ = 0.0;
  std::vector<FieldContact> in_field_;

  Instant now_;
  std::int64_t frame_index_ = 0;
  double frame_ = 0.0;
  bool whole_ = true;     ///< no frame was cut short by the end of the run
  bool resumed_ = false;  ///< this frame was drawn before the run was interrupted
  std::string reason_;    ///< of a stop
  EnergyLedger ledger_;
  EnergyAccount account_;
  Cost cost_;
};

/// 13.1, literally: every `current` with every `next` after it, in the order of creation; the first
/// overlap is handled and ends the search of this `current`, unless `next` was the last `next`
/// handled in this pass. Returns how many pairs were handled.
int detect_and_handle(FrameWorld& world);

/// Lets every field push what overlaps it now, until the next step.
void give_field_forces(FrameWorld& world);

}  // namespace core
}  // namespace kairos
