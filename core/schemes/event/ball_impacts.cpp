// `EventContacts` when plain balls strike each other or walls, in fewer words: most impacts of a
// gas.
#include "core/ball_detector.hpp"
#include "core/point_law.hpp"
#include "core/schemes/event/event_contacts.hpp"

#include <limits>
#include <tuple>
#include <variant>

namespace kairos {
inline namespace core {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

/// Whether body i is a fixed half-space.
bool EventContacts::is_wall(BodyIndex i) const {
  return run_.model.mobility(i) == Mobility::fixed &&
         std::holds_alternative<HalfSpace>(run_.model.shape(i));
}

/// Where the two of an impact, of which the states are set, touch, and how they bounce; null: a
/// wall.
Contact EventContacts::contact_of_balls(const Event& event, const PlainBall* ball_a,
                                        const PlainBall* ball_b) const {
  const Pose& at_a = event.before_a.pose;
  const Pose& at_b = event.before_b.pose;
  const bool wall = ball_a == nullptr || ball_b == nullptr;
  const Overlap o =
      wall ? run_.detector.overlap(run_.model.shape(event.a), at_a, run_.model.shape(event.b), at_b)
           : ball_detector_->ball_overlap(at_a.position, ball_a->radius, at_b.position,
                                          ball_b->radius);
  return {o.point, o.normal, o.gap,
          wall ? run_.model.restitution(event.a, event.b)
               : run_.plain_balls.restitution(*ball_a, *ball_b)};
}

/// `impact` of two plain balls, or of one and a wall without friction, that nothing else touches,
/// without looking for what they have not: the same, bit by bit. False, and nothing has changed but
/// that both are open, where more may have to be done.
bool EventContacts::impact_of_balls(BodyIndex a, BodyIndex b, Instant t, double bracket) {
  if (point_law_ == nullptr || ball_detector_ == nullptr || !graph_.empty()) {
    return false;
  }
  const PlainBall* const ball_a = motions_.is_plain(a) ? run_.plain_balls.find(a) : nullptr;
  const PlainBall* const ball_b = motions_.is_plain(b) ? run_.plain_balls.find(b) : nullptr;
  if (ball_a == nullptr || ball_b == nullptr) {
    const bool meets_wall = (ball_a != nullptr && is_wall(b)) || (ball_b != nullptr && is_wall(a));
    if (!meets_wall || run_.model.friction(a, b) != 0.0) {
      return false;
    }
  }
  Event event = impact_in(a, b, t, bracket);
  const auto open = [&](BodyIndex i, const PlainBall* ball) {
    return ball != nullptr ? motions_.open_ball(i, *ball, t) : motions_.now(i);
  };
  event.before_a = event.after_a = open(a, ball_a);
  event.before_b = event.after_b = open(b, ball_b);
  event.contact = contact_of_balls(event, ball_a, ball_b);
  const auto rate = [&event](const BodyState& of_a, const BodyState& of_b) {
    return event.contact.normal.dot(of_b.twist.linear - of_a.twist.linear);
  };
  const double approach = rate(event.before_a, event.before_b);
  if (!(approach < 0.0) || event.contact.gap > predictor_.least_touching_gap(ball_a, ball_b)) {
    return false;
  }
  const auto mass = [](const PlainBall* ball) { return ball != nullptr ? ball->mass : infinity; };
  const ImpactEnergy energy =
      point_law_->apply_to_points(event.contact, {mass(ball_a), event.after_a.twist.linear},
                                  {mass(ball_b), event.after_b.twist.linear});
  run_.struck(event, ball_a, ball_b);
  run_.ledger.add(EnergyLine::restitution_loss, energy.restitution_loss);
  const EventAccumulation::Rebound rebound{ball_a, ball_b, event, -approach,
                                           rate(event.after_a, event.after_b)};
  const EventAccumulation::Scale scale = accumulation_.scale_of(rebound);
  const bool parts = EventAccumulation::part_for_sure(rebound, scale);
  if (parts && accumulation_.go_on_for_sure(rebound, scale)) {
    go_on_plain(event, ball_a, ball_b);
    return true;
  }
  motions_.now(a) = event.after_a;
  motions_.now(b) = event.after_b;
  if (parts) {
    go_on_as_found(event, accumulation_.after_impact(rebound, scale), t);
  } else {
    go_on_struck(event, approach, {}, t);
  }
  return true;
}

/// The two go on as the impact has left them; null: a wall.
void EventContacts::go_on_plain(const Event& event, const PlainBall* ball_a,
                                const PlainBall* ball_b) {
  const auto [a, b, t] = std::tuple{event.a, event.b, event.time};
  if (ball_a != nullptr) {
    motions_.launch_ball(a, *ball_a, event.after_a, t);
  }
  if (ball_b != nullptr) {
    motions_.launch_ball(b, *ball_b, event.after_b, t);
  }
  if (ball_a != nullptr && ball_b != nullptr) {
    predictor_.predict_struck(a, b, t);
  } else {
    predictor_.predict(ball_a != nullptr ? a : b, t);
  }
}

}  // namespace core
}  // namespace kairos
