#include "core/archive.hpp"
#include "core/schemes/event_world.hpp"

// What an event-driven run needs to go on, between a frame that was drawn and the next.

namespace kairos {
inline namespace core {

void Support::persist(Archive& archive) { archive(surface, normal); }

void QueuedEvent::persist(Archive& archive) {
  archive(time, due, a, b, version_a, version_b, patience, decided);
}
/// The heap as it lies: what is due at the same instant keeps its order.
void EventQueue::persist(Archive& archive) { archive(heap_); }

void EventWorld::Actor::persist(Archive& archive) {
  archive(motion, version, horizon, reach, support, contact_begins, fields, creeping, last_impact,
          last_speed, impacts, octave_start, octave_duration, accelerating, swept.lower,
          swept.upper);
}

void EventWorld::Flow::persist(Archive& archive) {
  archive(island.constant_force, carried, states, launched, roundoff, booked);
  stepper->persist(archive);
}

void EventWorld::offer_checkpoint(Instant t, bool last) {
  if (options_.keeper == nullptr || !options_.keeper->wants(t, last)) {
    return;
  }
  Archive archive;
  persist(archive);
  options_.keeper->keep(t, archive.bytes());
}

void EventWorld::persist(Archive& archive) {
  archive(time_, epoch_end_, frame_index_, now_, booked_, drawn_, field_forces_, grasps_, in_hand_,
          actors_, queue_, ledger_, cost_);
  for (Flow& flow : flows_) {
    archive(flow);
  }
  recorder_.persist(archive);
}

void EventWorld::resume() {
  Archive archive(options_.resume);
  for (Flow& flow : flows_) {
    flow.stepper->start(flow.island, time_, flow.states);
  }
  persist(archive);
  for (Flow& flow : flows_) {
    const std::vector<Vector3> forces = field_forces_;  // as they were when it was launched
    const std::vector<Vector3> constant = flow.island.constant_force;
    set_forces(flow);
    flow.island.constant_force = constant;
    field_forces_ = forces;
  }
  if (broad_phase_) {
    for (const BodyIndex i : by_rank_) {
      broad_phase_->update(i, actors_[i].swept);
    }
  }
}

}  // namespace core
}  // namespace kairos
