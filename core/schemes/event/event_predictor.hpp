#pragma once

#include "core/contacts/contact_graph.hpp"
#include "core/schemes/event/event_motions.hpp"
#include "core/schemes/shared/grasps.hpp"

#include <memory>
#include <vector>

namespace kairos {
inline namespace core {

/// When will pairs meet or part? Asks the detector about the motions that bodies have, no further
/// than the end of the epoch, and puts the answers on the agenda.
class EventPredictor {
 public:
  EventPredictor(EventRun& run, const EventMotions& motions, const Grasps& grasps,
                 const ContactGraph& graph, const Method& method);

  /// All pairs, from t on.
  void predict_all(Instant t);
  /// All pairs of i.
  void predict(BodyIndex i, Instant t) { predict(i, t, i); }
  /// All pairs of i but that with `except`.
  void predict(BodyIndex i, Instant t, BodyIndex except);
  void predict_pair(BodyIndex i, BodyIndex j, Instant t);

  /// Solids that body i could touch now, appended.
  void solids_near(BodyIndex i, std::vector<BodyIndex>& out);

  /// Beyond this gap two bodies do not touch, m: twice what a detector may leave between them (its
  /// tolerance, the roundoff of the coordinates that their motions reach, their error radii). No
  /// impact law acts across more.
  [[nodiscard]] double touching_gap(BodyIndex a, BodyIndex b) const;

  void persist(Archive& archive);

 private:
  struct Watched {
    std::vector<BodyIndex> partners;  ///< what it can interact with, where there is no broad phase
    double reach = 0.0;  ///< how far it goes before its neighbours are looked up again, m
    Aabb swept{};        ///< what the broad phase was told

    void persist(Archive& archive);
  };

  void open_window(BodyIndex i, Instant t);
  [[nodiscard]] double window_length(BodyIndex i, Instant t);
  void predict_meeting(BodyIndex a, BodyIndex b, Instant t, double duration);
  [[nodiscard]] TimeOfImpact time_of_impact(BodyIndex a, BodyIndex b, Instant t, double duration);
  void push_meeting(BodyIndex a, BodyIndex b, Instant t, const TimeOfImpact& toi);
  void look_nearer(BodyIndex a, BodyIndex b, Instant t, double duration, TimeOfImpact toi);
  void predict_parting(BodyIndex a, BodyIndex b, Instant t, double duration, Due due);
  void leave_overlap(BodyIndex a, BodyIndex b, Instant t, double duration);
  /// What a query cost is told.
  TimeOfImpact counted(const TimeOfImpact& toi);
  TimeOfImpact without_errors(BodyIndex a, BodyIndex b, Instant t, double duration);
  [[nodiscard]] TimeOfImpact time_of_separation(BodyIndex a, BodyIndex b, Instant t,
                                                double duration);

  EventRun& run_;
  const EventMotions& motions_;
  const Grasps& grasps_;
  const ContactGraph& graph_;
  std::unique_ptr<BroadPhase> broad_phase_;  ///< null: every partner is a neighbour
  SweptBounds swept_bounds_;
  std::vector<Watched> bodies_;
  std::vector<BodyIndex> neighbours_;  ///< scratch
};

}  // namespace core
}  // namespace kairos
