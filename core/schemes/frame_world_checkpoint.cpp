#include "core/archive.hpp"
#include "core/schemes/frame_world.hpp"

// What a frame-based run needs to go on, between a frame that was drawn and the next.

namespace kairos {
inline namespace core {

static void persist(Archive& archive, TrackerMemory& memory) {
  archive(memory.primed, memory.accepted_position, memory.velocity);
}

void FrameWorld::Mover::persist(Archive& archive) {
  archive(island.constant_force, jumped, carried, states, last_step);
  stepper->persist(archive);
}

void FrameWorld::FieldContact::persist(Archive& archive) { archive(field, body, seen); }

void FrameWorld::offer_checkpoint(bool last) {
  if (options_.keeper == nullptr || !options_.keeper->wants(now_, last)) {
    return;
  }
  Archive archive;
  persist(archive);
  options_.keeper->keep(now_, archive.bytes());
}

void FrameWorld::persist(Archive& archive) {
  archive(now_, frame_index_, last_step_, bodies_, given_force_, any_given_, trackers_, grasps_,
          in_field_, ledger_, cost_);
  for (Mover& mover : movers_) {
    archive(mover);
  }
  recorder_.persist(archive);
}

}  // namespace core
}  // namespace kairos
