#include "core/schemes/event_world.hpp"

#include <algorithm>
#include <cmath>

// When will pairs meet or part?

namespace kairos {
inline namespace core {

void EventWorld::push(Instant t, Due due, BodyIndex a, BodyIndex b, double patience, bool decided) {
  queue_.push(
      {t, due, rank_[a], rank_[b], actors_[a].version, actors_[b].version, patience, decided});
}

void EventWorld::predict(BodyIndex i, Instant t, BodyIndex except) {
  if (!broad_phase_) {
    for (const BodyIndex j : actors_[i].partners) {
      if (j != except) {
        predict_pair(i, j, t);
      }
    }
    return;
  }
  open_window(i, t);
  neighbours_.clear();
  broad_phase_->candidates(i, neighbours_);
  for (const BodyIndex j : neighbours_) {
    if (j != except && model_.interacts(i, j)) {
      predict_pair(i, j, t);
    }
  }
  // Windows grow where few are near and shrink where many are: about ten neighbours cost least.
  Actor& actor = actors_[i];
  if (neighbours_.size() > 16) {
    actor.reach *= 0.5;
  } else if (neighbours_.size() < 8) {
    actor.reach *= 1.5;
  }
}

/// All pairs, from t on.
void EventWorld::predict_all(Instant t) {
  if (!broad_phase_) {
    for (const auto& [a, b] : model_.pairs()) {
      predict_pair(a, b, t);
    }
    return;
  }
  for (const BodyIndex i : by_rank_) {
    open_window(i, t);
  }
  for (const BodyIndex i : by_rank_) {
    neighbours_.clear();
    broad_phase_->candidates(i, neighbours_);
    for (const BodyIndex j : neighbours_) {
      if (i < j && model_.interacts(i, j)) {
        predict_pair(i, j, t);
      }
    }
  }
}

/// Tells the broad phase where i goes during its next window.
void EventWorld::open_window(BodyIndex i, Instant t) {
  Actor& actor = actors_[i];
  if (model_.is_free(i)) {
    actor.horizon = std::min({actor.motion.end(), epoch_end_, t + window_length(i, t)});
    if (actor.horizon < actor.motion.end() && actor.horizon < epoch_end_) {
      push(actor.horizon, Due::horizon, i, i);
    }
  }
  const Instant until = std::max(std::min(actor.horizon, epoch_end_), t);
  actor.swept = swept_bounds_({model_.shape(i), actor.motion}, {t, until - t});
  broad_phase_->update(i, actor.swept);
}

/// How long it takes i to go as far as its reach, s.
double EventWorld::window_length(BodyIndex i, Instant t) {
  Actor& actor = actors_[i];
  if (actor.reach == 0.0) {
    actor.reach = 4.0 * bounding_radius(model_.shape(i));
  }
  const double s = t - actor.motion.start;
  const double speed = actor.motion.velocity(s).norm();
  const double acceleration = actor.motion.acceleration(s).norm();
  // At least as far as its reach at constant acceleration: |v| t + |a| t^2 / 2 = reach.
  return 2.0 * actor.reach / (speed + std::sqrt(speed * speed + 2.0 * acceleration * actor.reach));
}

void EventWorld::predict_pair(BodyIndex i, BodyIndex j, Instant t) {
  // Queries go by name, so that their bits do not depend on who asks.
  const auto [a, b] = rank_[i] < rank_[j] ? std::pair{i, j} : std::pair{j, i};
  const bool leaving = is_leaving(a, b);
  if (!leaving && (in_hand_[a] != 0 || in_hand_[b] != 0)) {
    return;
  }
  const auto supported_by = [&](BodyIndex ball, BodyIndex surface) {
    return actors_[ball].support && actors_[ball].support->surface == surface;
  };
  if (supported_by(a, b) || supported_by(b, a)) {
    return;
  }
  const double duration =
      std::min({actors_[a].motion.end(), actors_[b].motion.end(), epoch_end_}) - t;
  if (!(duration > 0.0)) {
    return;
  }
  const auto inside = [&](BodyIndex body, BodyIndex field) {
    const auto& fields = actors_[body].fields;
    return std::find(fields.begin(), fields.end(), field) != fields.end();
  };
  if (leaving) {
    predict_parting(a, b, t, duration, Due::clear_of_hand);
  } else if (inside(a, b) || inside(b, a)) {
    predict_parting(a, b, t, duration, Due::field_left);
  } else {
    predict_meeting(a, b, t, duration);
  }
}

void EventWorld::predict_meeting(BodyIndex a, BodyIndex b, Instant t, double duration) {
  const TimeOfImpact toi = detector_.time_of_impact({model_.shape(a), actors_[a].motion},
                                                    {model_.shape(b), actors_[b].motion},
                                                    {t, duration}, options_.toi_tolerance);
  ++cost_.toi_queries;
  cost_.toi_evaluations += toi.evaluations;
  if (!model_.is_free(a) && !model_.is_free(b)) {
    return;  // asked all the same where nothing is left out; nothing can come of it
  }
  const bool field = model_.is_field(a) || model_.is_field(b);
  switch (toi.status) {
    case ToiStatus::separated:
      return;
    case ToiStatus::impact:
    case ToiStatus::undecided:
      // A field is entered where contact is proven; solids never get that far.
      push(t + (field ? toi.t_hi : toi.t_lo), field ? Due::field_entered : Due::impact, a, b,
           toi.t_hi - toi.t_lo, toi.status == ToiStatus::impact);
      return;
    case ToiStatus::overlapping:
      return field ? push(t, Due::field_entered, a, b) : leave_overlap(a, b, t, duration);
  }
}

/// Two solids that a computation left inside each other, by roundoff: an impact if they approach,
/// and nothing if they part; a pair that stays would fall through, so that the run stops.
void EventWorld::leave_overlap(BodyIndex a, BodyIndex b, Instant t, double duration) {
  const Overlap o =
      detector_.overlap(model_.shape(a), state_at(a, t).pose, model_.shape(b), state_at(b, t).pose);
  if (normal_velocity({o.point, o.normal, o.gap}, state_at(a, t), state_at(b, t)) < 0.0) {
    return push(t, Due::impact, a, b);
  }
  const TimeOfImpact toi = detector_.time_of_separation({model_.shape(a), actors_[a].motion},
                                                        {model_.shape(b), actors_[b].motion},
                                                        {t, duration}, options_.toi_tolerance);
  ++cost_.toi_queries;
  cost_.toi_evaluations += toi.evaluations;
  if (toi.status == ToiStatus::overlapping) {
    return stop(t, "accumulation: " + names(a, b) +
                       " stay in contact, and that is not a ball on a "
                       "surface");
  }
  push(t + toi.t_hi, Due::recheck, a, b);
}

void EventWorld::predict_parting(BodyIndex a, BodyIndex b, Instant t, double duration, Due due) {
  const TimeOfImpact toi = detector_.time_of_separation({model_.shape(a), actors_[a].motion},
                                                        {model_.shape(b), actors_[b].motion},
                                                        {t, duration}, options_.toi_tolerance);
  ++cost_.toi_queries;
  cost_.toi_evaluations += toi.evaluations;
  if (toi.status != ToiStatus::overlapping) {
    push(t + toi.t_hi, due, a, b);
  }
}

}  // namespace core
}  // namespace kairos
