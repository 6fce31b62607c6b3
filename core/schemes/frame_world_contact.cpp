#include "core/schemes/frame_world.hpp"

#include <algorithm>
#include <utility>

// What happens when two bodies are found in contact.

namespace kairos {
inline namespace core {

Contact FrameWorld::contact(BodyIndex a, BodyIndex b, const BodyState& state_a,
                            const BodyState& state_b) {
  const Overlap o = detector_.overlap(model_.shape(a), state_a.pose, model_.shape(b), state_b.pose);
  return {o.point, o.normal, o.gap};
}

void FrameWorld::collide(BodyIndex a, BodyIndex b, BodyState& state_a, BodyState& state_b,
                         Instant t) {
  if (model_.is_field(a) || model_.is_field(b)) {
    return meet_field(a, b);
  }
  Event event{.time = t, .kind = EventKind::impact, .a = a, .b = b};
  if (law_needs_contact_) {
    event.contact = contact(a, b, state_a, state_b);
  }
  event.before_a = state_a;
  event.before_b = state_b;
  const ImpactBody body_a{model_.body(a), model_.inertia(a), state_a, given_force_[a]};
  const ImpactBody body_b{model_.body(b), model_.inertia(b), state_b, given_force_[b]};
  const ImpactEnergy energy = law_.apply(event.contact, body_a, body_b);
  any_given_ = true;
  event.after_a = state_a;
  event.after_b = state_b;
  book_impact(energy, a, b);
  if (options_.roundoff) {
    ledger_.add(EnergyLine::roundoff,
                law_.roundoff(event.contact, body_a, body_b, event.before_a, event.before_b));
  }
  for (const auto& [i, before, after] :
       {std::tuple{a, &event.before_a, &state_a}, std::tuple{b, &event.before_b, &state_b}}) {
    if (!model_.is_free(i)) {
      continue;
    }
    movers_[model_.island_of(i)].jumped = true;
    if (after->pose.position != before->pose.position) {
      account_.moved(i, after->pose.position - before->pose.position);
    }
  }
  ++cost_.impacts;
  ++cost_.events;
  recorder_.event(event);
}

void FrameWorld::book_impact(const ImpactEnergy& energy, BodyIndex a, BodyIndex b) {
  if (energy.driven_work != 0.0) {
    ledger_.add(EnergyLine::driven_work, energy.driven_work);
  }
  if (energy.conveyor_and_hand != 0.0) {
    ledger_.add(EnergyLine::conveyor_and_hand, energy.conveyor_and_hand);
  }
  if (energy.restitution_loss != 0.0) {
    const double at_contact = loss_at_contact(a, b, energy.restitution_loss);
    ledger_.add(EnergyLine::restitution_loss, at_contact);
    ledger_.add(EnergyLine::late_impact, energy.restitution_loss - at_contact);
  }
}

Motion FrameWorld::last_motion(BodyIndex i) const {
  switch (model_.mobility(i)) {
    case Mobility::fixed:
      return paths_[i].front();
    case Mobility::driven:
      return model_.body(i).drive->motion(now_ - last_step_, last_step_);
    case Mobility::free:
      break;
  }
  const Mover& mover = movers_[model_.island_of(i)];
  std::vector<Motion> motions(mover.states.size());
  mover.stepper->dense_output(motions);
  for (std::size_t k = 0; k < motions.size(); ++k) {
    if (mover.island.bodies[k] == i) {
      return motions[k];
    }
  }
  return motions.front();
}

/// What the impact law would have taken at the moment of contact, found by bisection on the motions
/// of the last step. A pair that overlapped throughout that step has no such moment: 0 late.
double FrameWorld::loss_at_contact(BodyIndex a, BodyIndex b, double loss_when_handled) {
  if (last_step_ == 0.0) {
    return loss_when_handled;
  }
  const Motion motion_a = last_motion(a);
  const Motion motion_b = last_motion(b);
  const Instant begin = std::max(motion_a.start, motion_b.start);
  const auto state = [&](const Motion& m, double s) {
    const double local = (begin - m.start) + s;
    return BodyState{m.pose(local), m.twist(local)};
  };
  const auto apart = [&](double s) {
    return !detector_.overlaps(model_.shape(a), state(motion_a, s).pose, model_.shape(b),
                               state(motion_b, s).pose);
  };
  double early = 0.0;
  double late = std::min(motion_a.end(), motion_b.end()) - begin;
  if (!apart(early) || apart(late)) {
    return loss_when_handled;
  }
  for (int halvings = 0; halvings < 60; ++halvings) {
    const double middle = 0.5 * (early + late);
    (apart(middle) ? early : late) = middle;
  }
  BodyState state_a = state(motion_a, late);
  BodyState state_b = state(motion_b, late);
  Vector3 force_a = Vector3::Zero();
  Vector3 force_b = Vector3::Zero();
  return law_
      .apply(contact(a, b, state_a, state_b), {model_.body(a), model_.inertia(a), state_a, force_a},
             {model_.body(b), model_.inertia(b), state_b, force_b})
      .restitution_loss;
}

/// 5.8: a field pushes what overlaps it; nothing bounces.
void FrameWorld::meet_field(BodyIndex a, BodyIndex b) {
  const auto [field, body] = model_.is_field(a) ? std::pair{a, b} : std::pair{b, a};
  if (!model_.is_free(body)) {
    return;
  }
  given_force_[body] += field_force(model_, field, bodies_[field], body);
  any_given_ = true;
  for (FieldContact& inside : in_field_) {
    if (inside.field == field && inside.body == body) {
      inside.seen = true;
      return;
    }
  }
  in_field_.push_back({field, body, true});
  ++cost_.events;
  recorder_.event({.time = now_, .kind = EventKind::field_entered, .a = field, .b = body});
}

void FrameWorld::record_fields_left() {
  for (const FieldContact& inside : in_field_) {
    if (!inside.seen) {
      ++cost_.events;
      recorder_.event(
          {.time = now_, .kind = EventKind::field_left, .a = inside.field, .b = inside.body});
    }
  }
  std::erase_if(in_field_, [](const FieldContact& inside) { return !inside.seen; });
  for (FieldContact& inside : in_field_) {
    inside.seen = false;
  }
}

}  // namespace core
}  // namespace kairos
