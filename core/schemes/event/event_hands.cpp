#include "core/schemes/event/event_hands.hpp"

#include "core/schemes/shared/release.hpp"

#include <utility>

namespace kairos {
inline namespace core {

void EventHands::follow(BodyIndex hand, Instant t) {
  for (std::size_t k = 0; k < run_.model.grips().size(); ++k) {
    if (run_.model.grips()[k].hand != hand) {
      continue;
    }
    const bool closed = run_.model.body(hand).drive->closed(t);
    if (closed && grasps_.of(k) != Grasp::holding) {
      grasp(k, t);
    } else if (closed) {
      carry(k, 1.0, t);
    } else if (grasps_.of(k) == Grasp::holding) {
      release(k, t);
    }
  }
}

void EventHands::grasp(std::size_t grip, Instant t) {
  const auto [hand, held] = run_.model.grips()[grip];
  if (motions_.support(held)) {
    motions_.book(held, t);
    contacts_.end_contact(held, t);
  }
  const std::vector<BodyIndex> fields = motions_.fields(held);
  motions_.set_fields(held, {});
  for (const BodyIndex field : fields) {
    motions_.note(EventKind::field_left, field, held, t);
  }
  motions_.note(EventKind::grasped, hand, held, t);
  grasps_.set(grip, Grasp::holding);
  contacts_.take_out(held, t);
  carry(grip, 1.0, t);
}

/// Puts the held body where the hand is, with the given share of the hand's velocity.
void EventHands::carry(std::size_t grip, double share, Instant t) {
  const auto [hand, held] = run_.model.grips()[grip];
  motions_.book(held, t);
  const BodyState of_hand = motions_.at(hand, t);
  BodyState state = motions_.at(held, t);
  state.pose.position = of_hand.pose.position;
  state.twist = {share * of_hand.twist.linear, Vector3::Zero()};
  motions_.carry(held, hand, state, t);
}

void EventHands::release(std::size_t grip, Instant t) {
  const auto [hand, held] = run_.model.grips()[grip];
  carry(grip, run_.model.entity(hand).release_share(), t);
  motions_.let_go(held);
  grasps_.set(grip, Grasp::leaving);
  motions_.launch(held, t);
  motions_.note(EventKind::released, hand, held, t);
  meet_again(grip, t);
}

void EventHands::clear(BodyIndex a, BodyIndex b, Instant t) {
  if (const auto grip = grasps_.leaving(a, b)) {
    grasps_.set(*grip, Grasp::open);
    meet_again(*grip, t);
  }
}

/// The released body meets others from now on; the run stops if it is inside one of them.
void EventHands::meet_again(std::size_t grip, Instant t) {
  const auto pose = [&](BodyIndex i) { return motions_.at(i, t).pose; };
  const Grip& of = run_.model.grips()[grip];
  if (std::string why = why_not_released(run_, grasps_, of, t, pose); !why.empty()) {
    return run_.stop(t, std::move(why));
  }
  predictor_.predict(of.held, t);
}

}  // namespace core
}  // namespace kairos
