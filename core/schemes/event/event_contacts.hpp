#pragma once

#include "core/schemes/event/event_accumulation.hpp"
#include "core/schemes/event/event_motions.hpp"
#include "core/schemes/event/event_predictor.hpp"

#include <vector>

namespace kairos {
inline namespace core {

/// What happens when two bodies meet, come to rest on each other, part, or cross a field. Each of
/// these launches who is concerned and predicts what they meet next.
class EventContacts {
 public:
  EventContacts(EventRun& run, EventMotions& motions, EventPredictor& predictor);

  /// The detector told contact within `patience` (s) of t; `decided`: it proved it.
  void impact(BodyIndex a, BodyIndex b, Instant t, double patience, bool decided);
  void cross_field(BodyIndex a, BodyIndex b, Instant t, bool entering);

  /// The bounces of a ball have died down: told once, if it is still there.
  void begin_contact(BodyIndex i, Instant t);
  /// A supported ball is so no longer; takes effect with its next launch.
  void end_contact(BodyIndex i, Instant t);
  /// A supported ball comes to the end of its surface, or that draws away.
  void leave_support(BodyIndex i, Instant t);
  /// A driven surface has a new motion: what lies on it follows or flies.
  void carry_riders(BodyIndex surface, Instant t);

  void persist(Archive& archive);

 private:
  struct Touching {
    Instant settled = Instant::never();         ///< when it last came to rest on a surface
    Instant contact_begins = Instant::never();  ///< when its bounces have died down

    void persist(Archive& archive);
  };

  [[nodiscard]] Contact contact_at(BodyIndex a, BodyIndex b, Instant t, double patience) const;
  void look_again(BodyIndex a, BodyIndex b, Instant t, double patience);
  void touch(BodyIndex a, BodyIndex b, const Contact& contact, Instant t);
  [[nodiscard]] bool lands(BodyIndex a, BodyIndex b, const Contact& contact, Instant t);
  [[nodiscard]] bool leaves_for(BodyIndex ball, const Support& other, double tolerance, Instant t);
  void settle(BodyIndex ball, const Support& support, double pressing, double e, Instant t);
  void resume_support(BodyIndex i, Instant t);
  void follow(BodyIndex ball, const Support& support, Instant t);
  [[nodiscard]] double leaving_speed(BodyIndex ball, const Support& support, Instant t) const;
  void depart(BodyIndex a, BodyIndex b, Instant t);
  void relaunch(BodyIndex a, BodyIndex b, Instant t);
  [[nodiscard]] bool in_one_island(BodyIndex a, BodyIndex b) const;

  EventRun& run_;
  EventMotions& motions_;
  EventPredictor& predictor_;
  EventAccumulation accumulation_;
  std::vector<Touching> bodies_;
};

}  // namespace core
}  // namespace kairos
