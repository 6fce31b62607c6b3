#include "core/schemes/event_world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

// What happens when two bodies meet, come to rest on each other, or cross a field.

namespace kairos {
inline namespace core {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Impacts in a row between which a body has not moved by the tolerance: more are taken as an
/// accumulation point. A cradle or a break of a rack has a few.
constexpr int most_creeping = 200;
/// Ever faster impacts are looked for from this many on, and hops below this part of the extent.
constexpr std::int64_t many_impacts = 4096;
constexpr double small_hop = 1e-3;
/// Looks at a pair that go on by less than this part of its motions get nowhere.
constexpr double least_progress = 1e-12;

}  // namespace

std::string EventWorld::names(BodyIndex a, BodyIndex b) const {
  return "'" + model_.body(a).name + "' and '" + model_.body(b).name + "'";
}

void EventWorld::take() {
  const QueuedEvent event = queue_.pop();
  const BodyIndex a = by_rank_[event.a];
  const BodyIndex b = by_rank_[event.b];
  if (event.due == Due::epoch_end) {
    return next_epoch(event.time);
  }
  if (event.due == Due::contact_begins) {
    return begin_contact(a, event.time);
  }
  if (event.version_a != actors_[a].version || event.version_b != actors_[b].version) {
    return;
  }
  time_ = event.time;
  switch (event.due) {
    case Due::segment_end:
      return segment_end(a, event.time);
    case Due::support_ends:
      return leave_support(a, event.time);
    case Due::epoch_end:
    case Due::contact_begins:
      return;
    case Due::field_entered:
      return cross_field(a, b, event.time, true);
    case Due::field_left:
      return cross_field(a, b, event.time, false);
    case Due::clear_of_hand:
      return clear_of_hand(a, b, event.time);
    case Due::horizon:
      return predict(a, event.time);
    case Due::recheck:
      return predict_pair(a, b, event.time);
    case Due::impact:
      return impact(a, b, event.time, event.patience, event.decided);
  }
}

void EventWorld::note(EventKind kind, BodyIndex a, BodyIndex b, Instant t) {
  ++cost_.events;
  Event event{.time = t, .kind = kind, .a = a, .b = b};
  event.before_a = event.after_a = state_at(a, t);
  event.before_b = event.after_b = state_at(b, t);
  recorder_.event(event);
}

/// Told once, if the ball is still there: a new segment under it does not matter.
void EventWorld::begin_contact(BodyIndex i, Instant t) {
  Actor& actor = actors_[i];
  if (actor.support && actor.contact_begins == t) {
    time_ = t;
    actor.contact_begins = Instant{-1.0, 0.0};
    note(EventKind::contact_begins, i, actor.support->surface, t);
  }
}

void EventWorld::end_contact(BodyIndex i, Instant t) {
  Actor& actor = actors_[i];
  const BodyIndex surface = actor.support->surface;
  actor.support.reset();
  if (actor.contact_begins < t) {  // otherwise it was still hopping
    note(EventKind::contact_ends, i, surface, t);
  }
  actor.contact_begins = Instant::never();
}

/// Where the two touch at t: the centroid of the contact patch; where that does not approach, the
/// nearest points (one corner of several that are within tolerance).
Contact EventWorld::contact_at(BodyIndex a, BodyIndex b, Instant t, double patience) const {
  const Overlap o = detector_.overlap(model_.shape(a), now_[a].pose, model_.shape(b), now_[b].pose);
  const Contact patch{o.point, o.normal, o.gap};
  if (normal_velocity(patch, now_[a], now_[b]) < 0.0 || patience <= 0.0) {
    return patch;
  }
  const TimeOfImpact toi = detector_.time_of_impact({model_.shape(a), actors_[a].motion},
                                                    {model_.shape(b), actors_[b].motion},
                                                    {t, patience}, options_.toi_tolerance);
  const Contact nearest{0.5 * (toi.witness_a + toi.witness_b), toi.normal, toi.gap};
  const bool told = toi.status == ToiStatus::impact || toi.status == ToiStatus::undecided;
  return told && normal_velocity(nearest, now_[a], now_[b]) < 0.0 ? nearest : patch;
}

void EventWorld::impact(BodyIndex a, BodyIndex b, Instant t, double patience, bool decided) {
  for (const BodyIndex i : {a, b}) {
    if (model_.is_free(i)) {
      book(flow_of(i), t);
    }
    if (model_.mobility(i) != Mobility::fixed) {
      now_[i] = state_at(i, t);
    }
  }
  Event event{.time = t, .kind = EventKind::impact, .a = a, .b = b};
  event.contact = contact_at(a, b, t, patience);
  const double approach = normal_velocity(event.contact, now_[a], now_[b]);
  if (!decided && approach >= 0.0 && patience > 0.0) {
    return look_again(a, b, t, patience);
  }
  event.before_a = now_[a];
  event.before_b = now_[b];
  Vector3 unused_a = Vector3::Zero();  // solids that push (none does) would need fields
  Vector3 unused_b = Vector3::Zero();
  const ImpactBody body_a{model_.body(a), model_.inertia(a), now_[a], unused_a};
  const ImpactBody body_b{model_.body(b), model_.inertia(b), now_[b], unused_b};
  const ImpactEnergy energy = law_.apply(event.contact, body_a, body_b);
  event.after_a = now_[a];
  event.after_b = now_[b];
  ledger_.add(EnergyLine::restitution_loss, energy.restitution_loss);
  ledger_.add(EnergyLine::driven_work, energy.driven_work);
  ledger_.add(EnergyLine::conveyor_and_hand, energy.conveyor_and_hand);
  if (options_.roundoff) {
    ledger_.add(EnergyLine::roundoff,
                law_.roundoff(event.contact, body_a, body_b, event.before_a, event.before_b));
  }
  ++cost_.impacts;
  ++cost_.events;
  recorder_.event(event);

  const double rebound = normal_velocity(event.contact, now_[a], now_[b]);
  const double scale =
      std::abs(approach) + now_[a].twist.linear.norm() + now_[b].twist.linear.norm();
  if (rebound < -16.0 * epsilon * scale) {  // roundoff of a product and a few sums
    depart(a, b, t);
    return stop(t, fmt::format("still approaching: the impact law '{}' leaves {} approaching each "
                               "other at {} m/s",
                               law_.info().name, names(a, b), -rebound));
  }
  for (const BodyIndex i : {a, b}) {
    if (model_.is_free(i) &&
        now_[i].pose.position != (i == a ? event.before_a : event.before_b).pose.position) {
      account_.moved(
          i, now_[i].pose.position - (i == a ? event.before_a : event.before_b).pose.position);
    }
  }
  land(a, b, event.contact, t);
}

/// A pair within tolerance that does not approach is asked about again where the answer ends.
/// Answers that hardly get on, one after the other, would be asked for without end.
void EventWorld::look_again(BodyIndex a, BodyIndex b, Instant t, double patience) {
  const double window = std::min({actors_[a].motion.duration, actors_[b].motion.duration, epoch_});
  int& creeping = actors_[model_.is_free(a) ? a : b].creeping;
  creeping = patience < least_progress * window ? creeping + 1 : 0;
  if (creeping > most_creeping) {
    return stop(t, fmt::format("accumulation: whether {} touch is undecided again and again, and "
                               "time does not go on",
                               names(a, b)));
  }
  push(t + patience, Due::recheck, a, b);
}

/// How small a hop is taken for rest, m: with e < 1 the hops that would follow are summed up, so
/// the height only has to be far below anything measured; otherwise only what the coordinates
/// cannot resolve.
double EventWorld::rest_tolerance(BodyIndex a, BodyIndex b, double e) const {
  const double extent =
      std::min(smallest_extent(model_.shape(a)), smallest_extent(model_.shape(b)));
  const double coordinate = std::max(now_[a].pose.position.cwiseAbs().maxCoeff(),
                                     now_[b].pose.position.cwiseAbs().maxCoeff());
  return (e < 1.0 ? 1e-10 * extent : 0.0) + 4.0 * epsilon * coordinate;
}

/// After an impact: rest where the hop is too small to tell, stop where hops accumulate without a
/// support, fly on otherwise.
void EventWorld::land(BodyIndex a, BodyIndex b, const Contact& contact, Instant t) {
  const double e = model_.body(a).restitution * model_.body(b).restitution;
  const double tolerance = rest_tolerance(a, b, e);
  for (const BodyIndex ball : {a, b}) {
    const BodyIndex surface = ball == a ? b : a;
    if (!model_.is_free(ball) || model_.is_free(surface)) {
      continue;
    }
    const Motion& under = actors_[surface].motion;
    const double s = std::min(t - under.start, under.duration);
    const Vector3 normal = ball == b ? contact.normal : Vector3(-contact.normal);
    const auto support =
        find_support(model_, ball, now_[ball].pose.position, surface, under, s, normal);
    if (!support) {
      continue;
    }
    const double rebound = support->normal.dot(now_[ball].twist.linear - under.twist(s).linear);
    const double pressing = support->normal.dot(under.acceleration(s) -
                                                acting_force(ball, t, now_[ball], net_force(ball)) /
                                                    model_.inertia(ball).mass);
    if (pressing > 0.0 && rebound * rebound <= 2.0 * pressing * tolerance) {
      return settle(ball, *support, rebound, pressing, e, t);
    }
  }
  for (const BodyIndex i : {a, b}) {
    const double hop = small_hop * smallest_extent(model_.shape(i));
    if (model_.is_free(i) && (accelerates(i, hop, t) || creeps(i, tolerance, t))) {
      depart(a, b, t);  // what the last frame shows, and the ledger has booked
      return stop(t, fmt::format("accumulation: impacts of {} follow each other without end, and "
                                 "that is not a ball on a surface",
                                 names(a, b)));
    }
  }
  relaunch(a, b, t);
}

/// Whether impacts of i have followed each other many times without it moving as far as `reach`.
bool EventWorld::creeps(BodyIndex i, double reach, Instant t) {
  Actor& actor = actors_[i];
  const double speed =
      now_[i].twist.linear.norm() + now_[i].twist.angular.norm() * bounding_radius(model_.shape(i));
  const bool moved = !((t - actor.last_impact) * std::max(speed, actor.last_speed) <= reach);
  actor.creeping = moved || actor.last_impact == Instant::never() ? 0 : actor.creeping + 1;
  actor.last_impact = t;
  actor.last_speed = speed;
  return actor.creeping > most_creeping;
}

/// Whether impacts of i follow each other ever faster, as between a wall and a piston that comes
/// nearer: three times in a row twice as many impacts took less time than half as many before, and
/// from one to the next it moves less than `reach`. Such impacts end where the gap does; a gap of
/// 1e-9 would take 1e9 of them. Impacts at a steady rate take twice as long.
bool EventWorld::accelerates(BodyIndex i, double reach, Instant t) {
  Actor& actor = actors_[i];
  const std::int64_t n = ++actor.impacts;
  if (n < many_impacts || (n & (n - 1)) != 0) {
    return false;
  }
  const double duration = t - actor.octave_start;
  actor.accelerating = duration < actor.octave_duration ? actor.accelerating + 1 : 0;
  actor.octave_start = t;
  actor.octave_duration = duration;
  const double hop = (t - actor.last_impact) * actor.last_speed;
  return actor.accelerating >= 3 && hop <= reach;
}

/// The ball stays on the surface from now on. The hops it would still make, each e times as long as
/// the one before, add up to 2 u / (a (1 - e)): that is when contact begins.
void EventWorld::settle(BodyIndex ball, const Support& support, double rebound, double pressing,
                        double e, Instant t) {
  Actor& actor = actors_[ball];
  if (actor.support) {
    end_contact(ball, t);  // one surface at a time
  }
  const Motion& under = actors_[support.surface].motion;
  const double m = model_.inertia(ball).mass;
  const double ground = support.normal.dot(under.twist(t - under.start).linear);
  ledger_.add(EnergyLine::restitution_loss, -0.5 * m * rebound * rebound);
  ledger_.add(EnergyLine::driven_work, -m * rebound * ground);
  Vector3& v = now_[ball].twist.linear;
  v -= support.normal * (support.normal.dot(v) - ground);
  actor.support = support;
  actor.creeping = 0;
  launch(ball, t);
  const double still = e < 1.0 ? 2.0 * std::max(rebound, 0.0) / (pressing * (1.0 - e)) : 0.0;
  actor.contact_begins = t + still;
  if (actor.contact_begins < Instant::never()) {
    push(actor.contact_begins, Due::contact_begins, ball, support.surface);
  }
  predict(ball, t);
}

/// The islands of the two fly on from `now_`, where an impact has put them.
void EventWorld::depart(BodyIndex a, BodyIndex b, Instant t) {
  for (const BodyIndex i : {a, b}) {
    if (model_.is_free(i)) {
      for (const BodyIndex k : flow_of(i).island.bodies) {
        if (k != a && k != b) {
          now_[k] = state_at(k, t);
        }
      }
    }
  }
  const bool together =
      model_.is_free(a) && model_.is_free(b) && model_.island_of(a) == model_.island_of(b);
  for (const BodyIndex i : {a, b}) {
    if (!model_.is_free(i) || (together && i == b)) {
      continue;
    }
    if (actors_[i].support) {
      resume_support(i, t);
    }
    launch(i, t);
  }
}

void EventWorld::relaunch(BodyIndex a, BodyIndex b, Instant t) {
  depart(a, b, t);
  const bool together =
      model_.is_free(a) && model_.is_free(b) && model_.island_of(a) == model_.island_of(b);
  for (const BodyIndex i : {a, b}) {
    if (!model_.is_free(i) || (together && i == b)) {
      continue;
    }
    for (const BodyIndex k : flow_of(i).island.bodies) {
      // The pair itself is predicted once.
      predict(k, t, i == b && model_.is_free(a) ? a : k);
    }
  }
}

/// A supported ball was pushed: it stays if the push is along the surface.
void EventWorld::resume_support(BodyIndex i, Instant t) {
  Actor& actor = actors_[i];
  const Support support = *actor.support;
  const Motion& under = actors_[support.surface].motion;
  const double s = std::min(t - under.start, under.duration);
  const double away = support.normal.dot(now_[i].twist.linear - under.twist(s).linear);
  const double pressing = support.normal.dot(
      under.acceleration(s) -
      acting_force(i, t, now_[i], model_.gravity_force(i) + fields_at(i)) / model_.inertia(i).mass);
  const double tolerance = rest_tolerance(i, support.surface, 0.0);
  if (pressing > 0.0 && away * away <= 2.0 * pressing * tolerance) {
    const double ground = support.normal.dot(under.twist(s).linear);
    const double m = model_.inertia(i).mass;
    ledger_.add(EnergyLine::restitution_loss, -0.5 * m * away * away);
    ledger_.add(EnergyLine::driven_work, -m * away * ground);
    Vector3& v = now_[i].twist.linear;
    v -= support.normal * (support.normal.dot(v) - ground);
    return;
  }
  end_contact(i, t);
}

void EventWorld::leave_support(BodyIndex i, Instant t) {
  Flow& flow = flow_of(i);
  book(flow, t);
  now_[i] = state_at(i, t);
  end_contact(i, t);
  launch(i, t);
  predict(i, t);
}

/// A driven surface has a new motion: what lies on it follows or flies.
void EventWorld::riders(BodyIndex surface, Instant t) {
  for (const BodyIndex i : actors_[surface].partners) {
    if (!actors_[i].support || actors_[i].support->surface != surface) {
      continue;
    }
    book(flow_of(i), t);
    now_[i] = state_at(i, t);
    resume_support(i, t);
    launch(i, t);
    predict(i, t);
  }
}

void EventWorld::cross_field(BodyIndex a, BodyIndex b, Instant t, bool entering) {
  const auto [field, body] = model_.is_field(a) ? std::pair{a, b} : std::pair{b, a};
  book(flow_of(body), t);
  for (const BodyIndex k : flow_of(body).island.bodies) {
    now_[k] = state_at(k, t);
  }
  auto& fields = actors_[body].fields;
  if (entering) {
    fields.push_back(field);
  } else {
    fields.erase(std::remove(fields.begin(), fields.end(), field), fields.end());
  }
  note(entering ? EventKind::field_entered : EventKind::field_left, field, body, t);
  if (actors_[body].support) {
    resume_support(body, t);
  }
  launch(body, t);
  for (const BodyIndex k : flow_of(body).island.bodies) {
    predict(k, t);
  }
}

}  // namespace core
}  // namespace kairos
