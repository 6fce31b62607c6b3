#include "core/schemes/frame_world.hpp"

// Hands that hold, for the schemes that look at the world at given times (7.5).

namespace kairos {
inline namespace core {

/// Fists close and open at the times at which the world is looked at. What was held since the last
/// look has been where its hand is; a body that is let go starts there.
void FrameWorld::follow_hands() {
  for (std::size_t k = 0; k < model_.grips().size(); ++k) {
    const auto [hand, held] = model_.grips()[k];
    const bool closed = model_.body(hand).drive->closed(now_);
    if (grasps_.of(k) == Grasp::holding || closed) {
      const bool caught = grasps_.of(k) != Grasp::holding;
      const double share = closed ? 1.0 : model_.entity(hand).release_share();
      carry(hand, held, share);
      if (caught || !closed) {
        note_grasp(closed ? EventKind::grasped : EventKind::released, hand, held);
      }
      grasps_.set(k, closed ? Grasp::holding : Grasp::leaving);
      movers_[model_.island_of(held)].carried = closed;
    } else if (grasps_.of(k) == Grasp::leaving && !touches(hand, held)) {
      grasps_.set(k, Grasp::open);
    }
  }
}

/// The held body takes the hand's place and the given share of its velocity; what that does to its
/// energy is the hand's work.
void FrameWorld::carry(BodyIndex hand, BodyIndex held, double share) {
  Mover& mover = movers_[model_.island_of(held)];
  BodyState state = bodies_[held];
  state.pose.position = bodies_[hand].pose.position;
  state.twist = {share * bodies_[hand].twist.linear, Vector3::Zero()};
  after_[held] = state;
  account_.carried(mover.island, now_, bodies_, after_);
  bodies_[held] = state;
  mover.jumped = true;
}

void FrameWorld::note_grasp(EventKind kind, BodyIndex hand, BodyIndex held) {
  ++cost_.events;
  recorder_.event({.time = now_, .kind = kind, .a = hand, .b = held});
}

}  // namespace core
}  // namespace kairos
