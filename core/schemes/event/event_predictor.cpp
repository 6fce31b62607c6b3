#include "core/schemes/event/event_predictor.hpp"

#include "core/archive.hpp"

#include <algorithm>
#include <cmath>

namespace kairos {
inline namespace core {

EventPredictor::EventPredictor(EventRun& run, const EventMotions& motions, const Grasps& grasps,
                               const Method& method)
    : run_(run), motions_(motions), grasps_(grasps), bodies_(run.model.size()) {
  if (run.model.broad_phase() != "all-pairs") {
    broad_phase_ = method.broad_phase(run.model.size());
    swept_bounds_ = method.swept_bounds;
    return;
  }
  for (const auto& [a, b] : run.model.pairs()) {
    bodies_[a].partners.push_back(b);
    bodies_[b].partners.push_back(a);
  }
}

void EventPredictor::predict(BodyIndex i, Instant t, BodyIndex except) {
  if (!broad_phase_) {
    for (const BodyIndex j : bodies_[i].partners) {
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
    if (j != except && run_.model.interacts(i, j)) {
      predict_pair(i, j, t);
    }
  }
  // Windows grow where few are near and shrink where many are: about ten neighbours cost least.
  double& reach = bodies_[i].reach;
  if (neighbours_.size() > 16) {
    reach *= 0.5;
  } else if (neighbours_.size() < 8) {
    reach *= 1.5;
  }
}

void EventPredictor::predict_all(Instant t) {
  if (!broad_phase_) {
    for (const auto& [a, b] : run_.model.pairs()) {
      predict_pair(a, b, t);
    }
    return;
  }
  for (const BodyIndex i : run_.agenda.by_name()) {
    open_window(i, t);
  }
  for (const BodyIndex i : run_.agenda.by_name()) {
    neighbours_.clear();
    broad_phase_->candidates(i, neighbours_);
    for (const BodyIndex j : neighbours_) {
      if (i < j && run_.model.interacts(i, j)) {
        predict_pair(i, j, t);
      }
    }
  }
}

/// Tells the broad phase where i goes during its next window.
void EventPredictor::open_window(BodyIndex i, Instant t) {
  Instant horizon = std::min(motions_.of(i).end(), run_.epoch_end);
  if (run_.model.is_free(i)) {
    const Instant window_end = t + window_length(i, t);
    if (window_end < horizon) {
      horizon = window_end;
      run_.agenda.push(horizon, Due::horizon, i, i);
    }
  }
  Aabb& swept = bodies_[i].swept;
  swept = swept_bounds_(motions_.moving(i), {t, std::max(horizon, t) - t});
  broad_phase_->update(i, swept);
}

/// How long it takes i to go as far as its reach, s.
double EventPredictor::window_length(BodyIndex i, Instant t) {
  double& reach = bodies_[i].reach;
  if (reach == 0.0) {
    reach = 4.0 * bounding_radius(run_.model.shape(i));
  }
  const Motion& motion = motions_.of(i);
  const double s = t - motion.start;
  const double speed = motion.velocity(s).norm();
  const double acceleration = motion.acceleration(s).norm();
  // At least as far as its reach at constant acceleration: |v| t + |a| t^2 / 2 = reach.
  return 2.0 * reach / (speed + std::sqrt(speed * speed + 2.0 * acceleration * reach));
}

void EventPredictor::predict_pair(BodyIndex i, BodyIndex j, Instant t) {
  // Queries go by name, so that their bits do not depend on who asks.
  const auto [a, b] = run_.agenda.before(i, j) ? std::pair{i, j} : std::pair{j, i};
  const bool leaving = grasps_.leaving(a, b).has_value();
  if (!leaving && grasps_.involve(a, b)) {
    return;
  }
  if (motions_.is_supported_by(a, b) || motions_.is_supported_by(b, a)) {
    return;
  }
  const double duration =
      std::min({motions_.of(a).end(), motions_.of(b).end(), run_.epoch_end}) - t;
  if (!(duration > 0.0)) {
    return;
  }
  if (leaving) {
    predict_parting(a, b, t, duration, Due::clear_of_hand);
  } else if (motions_.is_in_field(a, b) || motions_.is_in_field(b, a)) {
    predict_parting(a, b, t, duration, Due::field_left);
  } else {
    predict_meeting(a, b, t, duration);
  }
}

void EventPredictor::predict_meeting(BodyIndex a, BodyIndex b, Instant t, double duration) {
  const TimeOfImpact toi = run_.detector.time_of_impact(motions_.moving(a), motions_.moving(b),
                                                        {t, duration}, run_.options.toi_tolerance);
  ++run_.cost.toi_queries;
  run_.cost.toi_evaluations += toi.evaluations;
  if (!run_.model.is_free(a) && !run_.model.is_free(b)) {
    return;  // asked all the same where nothing is left out; nothing can come of it
  }
  const bool field = run_.model.is_field(a) || run_.model.is_field(b);
  switch (toi.status) {
    case ToiStatus::separated:
      return;
    case ToiStatus::impact:
    case ToiStatus::undecided:
      // A field is entered where contact is proven; solids never get that far.
      return run_.agenda.push(t + (field ? toi.t_hi : toi.t_lo),
                              field ? Due::field_entered : Due::impact, a, b, toi.t_hi - toi.t_lo,
                              toi.status == ToiStatus::impact);
    case ToiStatus::overlapping:
      return field ? run_.agenda.push(t, Due::field_entered, a, b)
                   : leave_overlap(a, b, t, duration);
  }
}

/// Two solids that a computation left inside each other, by roundoff: an impact if they approach,
/// and nothing if they part; a pair that stays would fall through, so that the run stops.
void EventPredictor::leave_overlap(BodyIndex a, BodyIndex b, Instant t, double duration) {
  const BodyState state_a = motions_.at(a, t);
  const BodyState state_b = motions_.at(b, t);
  const Overlap o =
      run_.detector.overlap(run_.model.shape(a), state_a.pose, run_.model.shape(b), state_b.pose);
  if (normal_velocity({o.point, o.normal, o.gap}, state_a, state_b) < 0.0) {
    return run_.agenda.push(t, Due::impact, a, b);
  }
  const TimeOfImpact toi = time_of_separation(a, b, t, duration);
  if (toi.status == ToiStatus::overlapping) {
    return run_.stop(t, "accumulation: " + run_.names(a, b) +
                            " stay in contact, and that is not a ball on a surface");
  }
  run_.agenda.push(t + toi.t_hi, Due::recheck, a, b);
}

void EventPredictor::predict_parting(BodyIndex a, BodyIndex b, Instant t, double duration,
                                     Due due) {
  const TimeOfImpact toi = time_of_separation(a, b, t, duration);
  if (toi.status != ToiStatus::overlapping) {
    run_.agenda.push(t + toi.t_hi, due, a, b);
  }
}

TimeOfImpact EventPredictor::time_of_separation(BodyIndex a, BodyIndex b, Instant t,
                                                double duration) {
  const TimeOfImpact toi = run_.detector.time_of_separation(
      motions_.moving(a), motions_.moving(b), {t, duration}, run_.options.toi_tolerance);
  ++run_.cost.toi_queries;
  run_.cost.toi_evaluations += toi.evaluations;
  return toi;
}

void EventPredictor::Watched::persist(Archive& archive) {
  archive(reach, swept.lower, swept.upper);
}

void EventPredictor::persist(Archive& archive) {
  archive(bodies_);
  if (archive.reading() && broad_phase_) {
    for (const BodyIndex i : run_.agenda.by_name()) {
      broad_phase_->update(i, bodies_[i].swept);
    }
  }
}

}  // namespace core
}  // namespace kairos
