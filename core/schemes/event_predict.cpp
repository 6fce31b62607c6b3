#include "core/schemes/event_world.hpp"

#include <algorithm>

// When will pairs meet or part?

namespace kairos {
inline namespace core {

void EventWorld::push(Instant t, Due due, BodyIndex a, BodyIndex b, double patience) {
  queue_.push({t, due, rank_[a], rank_[b], actors_[a].version, actors_[b].version, patience});
}

void EventWorld::predict(BodyIndex i, Instant t) {
  for (const BodyIndex j : actors_[i].partners) {
    predict_pair(i, j, t);
  }
}

void EventWorld::predict_pair(BodyIndex i, BodyIndex j, Instant t) {
  // Queries go by name, so that their bits do not depend on who asks.
  const auto [a, b] = rank_[i] < rank_[j] ? std::pair{i, j} : std::pair{j, i};
  const auto supported_by = [&](BodyIndex ball, BodyIndex surface) {
    return actors_[ball].support && actors_[ball].support->surface == surface;
  };
  if (supported_by(a, b) || supported_by(b, a)) {
    return;
  }
  const double duration = std::min({actors_[a].motion.end(), actors_[b].motion.end(), end_}) - t;
  if (!(duration > 0.0)) {
    return;
  }
  const auto inside = [&](BodyIndex body, BodyIndex field) {
    const auto& fields = actors_[body].fields;
    return std::find(fields.begin(), fields.end(), field) != fields.end();
  };
  if (inside(a, b) || inside(b, a)) {
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
  const bool field = model_.is_field(a) || model_.is_field(b);
  switch (toi.status) {
    case ToiStatus::separated:
      return;
    case ToiStatus::impact:
    case ToiStatus::undecided:
      // A field is entered where contact is proven; solids never get that far.
      push(t + (field ? toi.t_hi : toi.t_lo), field ? Due::field_entered : Due::impact, a, b,
           toi.t_hi - toi.t_lo);
      return;
    case ToiStatus::overlapping:
      if (field) {
        push(t, Due::field_entered, a, b);
        return;
      }
      const Overlap o = detector_.overlap(model_.shape(a), state_at(a, t).pose, model_.shape(b),
                                          state_at(b, t).pose);
      if (normal_velocity({o.point, o.normal, o.gap}, state_at(a, t), state_at(b, t)) < 0.0) {
        push(t, Due::impact, a, b);
      } else {
        predict_parting(a, b, t, duration, Due::recheck);
      }
      return;
  }
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
