#include "core/schemes/frame/frame_hands.hpp"

#include "core/schemes/shared/release.hpp"

#include <utility>

namespace kairos {
inline namespace core {

void FrameHands::follow() {
  for (std::size_t k = 0; k < run_.model.grips().size(); ++k) {
    const Grip& grip = run_.model.grips()[k];
    const auto [hand, held] = grip;
    const bool closed = run_.model.body(hand).drive->closed(run_.time);
    if (grasps_.of(k) == Grasp::holding || closed) {
      const bool caught = grasps_.of(k) != Grasp::holding;
      carry(grip, closed ? 1.0 : run_.model.entity(hand).release_share());
      if (caught || !closed) {
        run_.tell(closed ? EventKind::grasped : EventKind::released, hand, held);
      }
      grasps_.set(k, closed ? Grasp::holding : Grasp::leaving);
      motions_.set_carried(held, closed);
      if (!closed) {
        check_free(grip);
      }
    } else if (grasps_.of(k) == Grasp::leaving && !run_.touch(hand, held)) {
      grasps_.set(k, Grasp::open);
      check_free(grip);
    }
  }
}

/// A released body has contacts from now on, so it must not be inside a solid.
void FrameHands::check_free(const Grip& grip) {
  const auto pose = [this](BodyIndex i) { return run_.bodies[i].pose; };
  if (std::string why = why_not_released(run_, grasps_, grip, run_.time, pose); !why.empty()) {
    run_.stop(std::move(why));
  }
}

/// Puts the held body where the hand is, with the given share of the hand's velocity.
void FrameHands::carry(const Grip& grip, double share) {
  BodyState state = run_.bodies[grip.held];
  state.pose.position = run_.bodies[grip.hand].pose.position;
  state.twist = {share * run_.bodies[grip.hand].twist.linear, Vector3::Zero()};
  motions_.carry(grip.held, state);
}

}  // namespace core
}  // namespace kairos
