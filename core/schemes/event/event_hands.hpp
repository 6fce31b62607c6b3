#pragma once

#include "core/schemes/event/event_contacts.hpp"

namespace kairos {
inline namespace core {

/// Hands that hold, from event to event (7.5). A held body has its hand's motion, segment by
/// segment, and nothing is predicted for it until it is let go of and clear of the hand.
class EventHands {
 public:
  EventHands(EventRun& run, EventMotions& motions, EventPredictor& predictor,
             EventContacts& contacts, Grasps& grasps)
      : run_(run), motions_(motions), predictor_(predictor), contacts_(contacts), grasps_(grasps) {}

  /// The hand has a new motion: what it holds follows, and a fist may close or open here.
  void follow(BodyIndex hand, Instant t);
  /// What one of the two has let go of is clear of it: from now on it meets things again.
  void clear(BodyIndex a, BodyIndex b, Instant t);

 private:
  void grasp(std::size_t grip, Instant t);
  void carry(std::size_t grip, double share, Instant t);
  void release(std::size_t grip, Instant t);
  void meet_again(std::size_t grip, Instant t);

  EventRun& run_;
  EventMotions& motions_;
  EventPredictor& predictor_;
  EventContacts& contacts_;
  Grasps& grasps_;
};

}  // namespace core
}  // namespace kairos
