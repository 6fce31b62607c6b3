#pragma once

#include "core/schemes/event/event_contacts.hpp"
#include "core/schemes/event/event_hands.hpp"
#include "core/schemes/event/event_motions.hpp"
#include "core/schemes/event/event_predictor.hpp"
#include "core/schemes/shared/frame_clock.hpp"
#include "core/schemes/shared/grasps.hpp"

namespace kairos {
inline namespace core {

/// The asynchronous world of `event-driven`: every body has its own current motion, and an agenda
/// holds what is due. Nothing here works over all bodies, except drawing a frame.
///
/// The life of a motion: an island is *launched* at a state (`EventMotions`), its pairs are
/// *predicted* (`EventPredictor`), and what was predicted is due until one of the two bodies is
/// launched again, by what happens between them and others (`EventContacts`, `EventHands`).
class EventWorld {
 public:
  EventWorld(const Model& model, const Method& method, const SchemeOptions& options,
             Recorder& recorder);

  /// Launches every body and predicts every pair, or goes on from a checkpoint; false if that was
  /// made where the run ends.
  [[nodiscard]] bool begin();
  [[nodiscard]] bool stopped() const { return run_.stopped(); }
  /// Whether something is due before the next frame is drawn.
  [[nodiscard]] bool due() { return run_.agenda.due_before(clock_.next()); }
  /// Takes the earliest event; stale ones change nothing.
  void take();
  /// Draws the frame that is due, or where the run stopped; false when it was the last.
  bool draw();
  [[nodiscard]] RunResult result() &&;

 private:
  void take(const DueEvent& event);
  void look_ahead();
  void next_epoch(Instant t);
  void end_segment(BodyIndex i, Instant t);
  bool open_frame();
  void persist(Archive& archive);

  EventRun run_;
  Grasps grasps_;
  ContactGraph graph_;
  EventMotions motions_;
  EventPredictor predictor_;
  EventContacts contacts_;
  EventHands hands_;

  FrameClock clock_;
  const bool looks_ahead_;  ///< there are more bodies than the caches near the processor hold
};

}  // namespace core
}  // namespace kairos
