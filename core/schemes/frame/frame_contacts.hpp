#pragma once

#include "core/schemes/frame/frame_motions.hpp"

#include <vector>

namespace kairos {
inline namespace core {

/// What two bodies do to each other when a frame-based scheme has found them in contact.
class FrameContacts {
 public:
  FrameContacts(FrameRun& run, FrameMotions& motions)
      : run_(run), motions_(motions), law_needs_contact_(run.law.info().needs_contact) {}

  /// 13.5: the two exchange what their entities and the impact law say, which changes the states;
  /// a field gives its force instead.
  void handle(BodyIndex a, BodyIndex b, BodyState& state_a, BodyState& state_b, Instant t);
  /// Tells which bodies have left a field since this was last called.
  void tell_fields_left();

  void persist(Archive& archive);

 private:
  /// A body in a field; `seen`: in the latest detection, too.
  struct FieldContact {
    BodyIndex field = 0, body = 0;
    bool seen = false;

    void persist(Archive& archive);
  };

  void meet_field(BodyIndex a, BodyIndex b);
  [[nodiscard]] Contact contact(BodyIndex a, BodyIndex b, const BodyState& state_a,
                                const BodyState& state_b) const;
  void book(const ImpactEnergy& energy, BodyIndex a, BodyIndex b);
  [[nodiscard]] double loss_at_contact(BodyIndex a, BodyIndex b, double loss_when_handled) const;

  FrameRun& run_;
  FrameMotions& motions_;
  const bool law_needs_contact_;
  std::vector<FieldContact> in_field_;
};

}  // namespace core
}  // namespace kairos
