#include "core/schemes/event_world.hpp"

#include <utility>

// Hands that hold, from event to event (7.5). A held body has its hand's motion, segment by
// segment, and nothing is predicted for it until it is let go of and clear of the hand.

namespace kairos {
inline namespace core {

/// The hand has a new motion: what it holds follows, and a fist may close or open here.
void EventWorld::follow_hand(BodyIndex hand, Instant t) {
  for (std::size_t k = 0; k < model_.grips().size(); ++k) {
    if (model_.grips()[k].hand != hand) {
      continue;
    }
    const BodyIndex held = model_.grips()[k].held;
    const bool closed = model_.body(hand).drive->closed(t);
    if (closed && grasps_[k] != Grasp::holding) {
      grasp(k, t);
    } else if (closed) {
      carry(hand, held, 1.0, t);
    } else if (grasps_[k] == Grasp::holding) {
      release(k, t);
    }
  }
}

void EventWorld::grasp(std::size_t k, Instant t) {
  const auto [hand, held] = model_.grips()[k];
  Actor& actor = actors_[held];
  if (actor.support) {
    book(flow_of(held), t);
    end_contact(held, t);
  }
  for (const BodyIndex field : std::exchange(actor.fields, {})) {
    note(EventKind::field_left, field, held, t);
  }
  note(EventKind::grasped, hand, held, t);
  grasps_[k] = Grasp::holding;
  in_hand_[held] = 1;
  carry(hand, held, 1.0, t);
}

/// The held body has the hand's motion from t on; what changes its energy is the hand's work.
void EventWorld::carry(BodyIndex hand, BodyIndex held, double share, Instant t) {
  Flow& flow = flow_of(held);
  book(flow, t);
  flow.carried = true;
  BodyState state = state_at(held, t);
  const BodyState of_hand = state_at(hand, t);
  state.pose.position = of_hand.pose.position;
  state.twist = {share * of_hand.twist.linear, Vector3::Zero()};
  now_[held] = state;
  account_.carried(flow.island, t, booked_, now_);
  booked_[held] = state;
  flow.booked = t;
  Motion motion = actors_[hand].motion.shifted(t - actors_[hand].motion.start);
  motion.rotation = RotationKind::fixed;
  motion.quaternion = Motion::at_rest(t, state.pose).quaternion;
  motion.angular_velocity = {};
  set_motion(held, motion);
}

void EventWorld::release(std::size_t k, Instant t) {
  const auto [hand, held] = model_.grips()[k];
  carry(hand, held, model_.entity(hand).release_share(), t);
  flow_of(held).carried = false;
  grasps_[k] = Grasp::leaving;
  launch(held, t);
  note(EventKind::released, hand, held, t);
  predict(held, t);
}

/// Let go of and clear of the hand: from now on it meets things again.
void EventWorld::clear_of_hand(BodyIndex a, BodyIndex b, Instant t) {
  for (std::size_t k = 0; k < model_.grips().size(); ++k) {
    const auto [hand, held] = model_.grips()[k];
    const bool this_pair = (hand == a && held == b) || (hand == b && held == a);
    if (this_pair && grasps_[k] == Grasp::leaving) {
      grasps_[k] = Grasp::open;
      in_hand_[held] = 0;
      predict(held, t);
    }
  }
}

bool EventWorld::is_leaving(BodyIndex a, BodyIndex b) const {
  for (std::size_t k = 0; k < model_.grips().size(); ++k) {
    const auto [hand, held] = model_.grips()[k];
    if (grasps_[k] == Grasp::leaving && ((hand == a && held == b) || (hand == b && held == a))) {
      return true;
    }
  }
  return false;
}

}  // namespace core
}  // namespace kairos
