#pragma once

#include "core/model.hpp"
#include "core/scheme.hpp"
#include "core/schemes/energy_account.hpp"
#include "core/schemes/event_queue.hpp"
#include "core/schemes/grasp.hpp"
#include "core/schemes/support.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kairos {
inline namespace core {

/// The asynchronous world of `event-driven`: every body has its own current motion and version,
/// and a queue holds what is due. Nothing here works over all bodies, except drawing a frame.
///
/// The life of a motion: an island is *launched* at a state (its stepper says how it moves), its
/// pairs are *predicted* (the detector says when they meet), and what was predicted is due until
/// one of the two bodies is launched again.
class EventWorld {
 public:
  EventWorld(const Model& model, const Method& method, const SchemeOptions& options,
             Recorder& recorder);

  /// Launches every body and predicts every pair, or goes on from a checkpoint; false if that was
  /// made where the run ends.
  [[nodiscard]] bool begin();
  [[nodiscard]] bool stopped() const { return !reason_.empty(); }
  /// Whether something is due before the next frame is drawn.
  [[nodiscard]] bool due() const { return !queue_.empty() && queue_.top().time < next_frame_; }
  /// Takes the earliest event; stale ones change nothing.
  void take();
  /// Draws the frame that is due; false when it was the last.
  bool draw();
  [[nodiscard]] RunResult result() &&;

 private:
  /// A body as the queue knows it.
  struct Actor {
    Motion motion;
    std::uint32_t version = 0;
    Instant horizon;     ///< its pairs have been predicted up to here
    double reach = 0.0;  ///< how far it goes before its neighbours are looked up again, m
    std::optional<Support> support;
    Instant contact_begins = Instant::never();  ///< when its bounces have died down
    std::vector<BodyIndex> partners;            ///< it can interact with, by name
    std::vector<BodyIndex> fields;              ///< it is in
    int creeping = 0;                           ///< events in a row between which it hardly moved
    Instant last_impact = Instant::never();
    double last_speed = 0.0;       ///< after that impact, m/s
    std::int64_t impacts = 0;      ///< so far
    Instant octave_start{};        ///< when `impacts` was last a power of two
    double octave_duration = 0.0;  ///< of the doubling before, s
    int accelerating = 0;          ///< doublings in a row, each shorter than the one before
    Aabb swept{};                  ///< what the broad phase was told

    void persist(Archive& archive);
  };
  struct Flow {
    Island island;
    std::unique_ptr<Stepper> stepper;
    bool exact = false;
    bool carried = false;             ///< a hand holds its body
    std::vector<BodyState> states{};  ///< at the end of the segment
    std::vector<Motion> motions{};
    std::unique_ptr<SupportForce> support{};  ///< while it slides under state-dependent forces
    std::vector<BodyState> launched{};        ///< where the segment began: for replays
    std::vector<ReplayedStep> replayed{};
    double roundoff = 0.0;  ///< of the segment so far, J
    Instant booked{};       ///< how far the ledger has followed it

    void persist(Archive& archive);
  };

  // Motions
  void launch(BodyIndex i, Instant t);       ///< the island of i, from `now_state`
  void next_segment(Flow& flow, Instant t);  ///< one stepper step, as motions
  void drive(BodyIndex i, Instant t);        ///< the next motion of a driven body
  void set_forces(Flow& flow);
  void set_motion(BodyIndex i, const Motion& motion);
  void hold(Flow& flow, Instant t);  ///< keeps a supported ball on its surface
  [[nodiscard]] BodyState state_at(BodyIndex i, Instant t) const;
  [[nodiscard]] Vector3 fields_at(BodyIndex i) const;
  [[nodiscard]] Vector3 net_force(BodyIndex i) const;  ///< the constant ones, N
  /// `constant` and what depends on the state, of a body that is alone in its island, N.
  [[nodiscard]] Vector3 acting_force(BodyIndex i, Instant t, const BodyState& state,
                                     const Vector3& constant) const;

  // Predictions
  void predict_all(Instant t);
  void next_epoch(Instant t);
  void predict(BodyIndex i, Instant t) { predict(i, t, i); }
  void predict(BodyIndex i, Instant t, BodyIndex except);
  void open_window(BodyIndex i, Instant t);
  [[nodiscard]] double window_length(BodyIndex i, Instant t);
  void predict_pair(BodyIndex i, BodyIndex j, Instant t);
  void predict_meeting(BodyIndex a, BodyIndex b, Instant t, double duration);
  void predict_parting(BodyIndex a, BodyIndex b, Instant t, double duration, Due due);
  void push(Instant t, Due due, BodyIndex a, BodyIndex b, double patience = 0.0,
            bool decided = true);
  void leave_overlap(BodyIndex a, BodyIndex b, Instant t, double duration);

  // Hands
  void follow_hand(BodyIndex hand, Instant t);
  void grasp(std::size_t k, Instant t);  ///< k: of the model's grips
  void carry(BodyIndex hand, BodyIndex held, double share, Instant t);
  void release(std::size_t k, Instant t);
  void clear_of_hand(BodyIndex a, BodyIndex b, Instant t);
  [[nodiscard]] bool is_leaving(BodyIndex a, BodyIndex b) const;

  // Events
  void impact(BodyIndex a, BodyIndex b, Instant t, double patience, bool decided);
  [[nodiscard]] Contact contact_at(BodyIndex a, BodyIndex b, Instant t, double patience) const;
  void look_again(BodyIndex a, BodyIndex b, Instant t, double patience);
  void land(BodyIndex a, BodyIndex b, const Contact& contact, Instant t);
  void settle(BodyIndex ball, const Support& support, double rebound, double pressing, double e,
              Instant t);
  void resume_support(BodyIndex i, Instant t);
  void leave_support(BodyIndex i, Instant t);
  void end_contact(BodyIndex i, Instant t);
  void begin_contact(BodyIndex i, Instant t);
  void riders(BodyIndex surface, Instant t);
  void cross_field(BodyIndex a, BodyIndex b, Instant t, bool entering);
  void segment_end(BodyIndex i, Instant t);
  void depart(BodyIndex a, BodyIndex b, Instant t);
  void relaunch(BodyIndex a, BodyIndex b, Instant t);
  [[nodiscard]] bool creeps(BodyIndex i, double reach, Instant t);
  [[nodiscard]] bool accelerates(BodyIndex i, double reach, Instant t);
  [[nodiscard]] double rest_tolerance(BodyIndex a, BodyIndex b, double e) const;
  void note(EventKind kind, BodyIndex a, BodyIndex b, Instant t);
  void stop(Instant t, std::string reason);

  // Frames
  bool open_frame(Instant t);
  void offer_checkpoint(Instant t, bool last);
  void persist(Archive& archive);
  void resume();

  // Ledger
  void book(Flow& flow, Instant t);
  [[nodiscard]] double new_roundoff(Flow& flow, Instant t);

  [[nodiscard]] Flow& flow_of(BodyIndex i) { return flows_[model_.island_of(i)]; }
  [[nodiscard]] std::string names(BodyIndex a, BodyIndex b) const;

  const Model& model_;
  const ContactDetector& detector_;
  const ImpactLaw& law_;
  const SchemeOptions& options_;
  Recorder& recorder_;
  const bool wants_motions_;

  std::vector<BodyIndex> by_rank_;  ///< bodies in the order of their names
  std::vector<std::uint32_t> rank_;
  std::vector<Actor> actors_;
  std::vector<Flow> flows_;
  State now_;     ///< states being changed by the event at hand
  State booked_;  ///< where the ledger is
  State drawn_;   ///< scratch for frames
  std::vector<Vector3> field_forces_;
  std::vector<Grasp> grasps_;  ///< of the model's grips
  std::vector<char> in_hand_;  ///< by body: no contacts
  EventQueue queue_;
  std::unique_ptr<BroadPhase> broad_phase_;  ///< null: every partner is a neighbour
  SweptBounds swept_bounds_;
  std::vector<BodyIndex> neighbours_;  ///< scratch

  Instant time_;  ///< of the last event or frame
  Instant end_;
  /// Nothing is predicted beyond the end of the epoch, which lasts as long as the scene says that
  /// it is of interest: predictions, hence bits, do not depend on when the run is to end.
  Instant epoch_end_;
  double epoch_ = 0.0;  ///< s
  Instant next_frame_;
  std::int64_t frame_index_ = 0;
  bool whole_ = true;  ///< no frame was cut short by the end of the run
  std::string reason_;
  EnergyLedger ledger_;
  EnergyAccount account_;
  Cost cost_;
};

}  // namespace core
}  // namespace kairos
