#include "core/schemes/frame/frame_contacts.hpp"

#include <algorithm>
#include <utility>

namespace kairos {
inline namespace core {

Contact FrameContacts::contact(BodyIndex a, BodyIndex b, const BodyState& state_a,
                               const BodyState& state_b) const {
  const Overlap o =
      run_.detector.overlap(run_.model.shape(a), state_a.pose, run_.model.shape(b), state_b.pose);
  return {o.point, o.normal, o.gap, run_.model.restitution(a, b), run_.model.friction(a, b)};
}

void FrameContacts::handle(BodyIndex a, BodyIndex b, BodyState& state_a, BodyState& state_b,
                           Instant t) {
  if (run_.model.is_field(a) || run_.model.is_field(b)) {
    return meet_field(a, b);
  }
  Event event{.time = t, .kind = EventKind::impact, .a = a, .b = b};
  if (law_needs_contact_) {
    event.contact = contact(a, b, state_a, state_b);
  }
  book(run_.exchange(event, state_a, state_b, run_.given_force[a], run_.given_force[b]), a, b);
  run_.any_given = true;
  for (const BodyIndex i : {a, b}) {
    if (run_.model.is_free(i)) {
      motions_.jump(i);
    }
  }
}

void FrameContacts::book(const ImpactEnergy& energy, BodyIndex a, BodyIndex b) {
  if (energy.driven_work != 0.0) {
    run_.ledger.add(EnergyLine::driven_work, energy.driven_work);
  }
  if (energy.conveyor_and_hand != 0.0) {
    run_.ledger.add(EnergyLine::conveyor_and_hand, energy.conveyor_and_hand);
  }
  if (energy.restitution_loss != 0.0) {
    const double at_contact = loss_at_contact(a, b, energy.restitution_loss);
    run_.ledger.add(EnergyLine::restitution_loss, at_contact);
    run_.ledger.add(EnergyLine::late_impact, energy.restitution_loss - at_contact);
  }
}

/// The restitution loss that the impact law would have caused at the moment of contact, which is
/// found by bisection on the motions of the last step. A pair that overlapped throughout has no
/// such moment: 0 late.
double FrameContacts::loss_at_contact(BodyIndex a, BodyIndex b, double loss_when_handled) const {
  if (run_.last_step == 0.0) {
    return loss_when_handled;
  }
  const Motion motion_a = motions_.last_motion(a);
  const Motion motion_b = motions_.last_motion(b);
  const Instant begin = std::max(motion_a.start, motion_b.start);
  const auto state = [&](const Motion& m, double s) {
    const double local = (begin - m.start) + s;
    return BodyState{m.pose(local), m.twist(local)};
  };
  const auto apart = [&](double s) {
    return !run_.detector.overlaps(run_.model.shape(a), state(motion_a, s).pose,
                                   run_.model.shape(b), state(motion_b, s).pose);
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
  return run_.law
      .apply(contact(a, b, state_a, state_b),
             {run_.model.body(a), run_.model.inertia(a), state_a, force_a},
             {run_.model.body(b), run_.model.inertia(b), state_b, force_b})
      .restitution_loss;
}

/// 5.8: a field pushes what overlaps it; nothing bounces.
void FrameContacts::meet_field(BodyIndex a, BodyIndex b) {
  const auto [field, body] = run_.model.is_field(a) ? std::pair{a, b} : std::pair{b, a};
  if (!run_.model.is_free(body)) {
    return;
  }
  run_.given_force[body] += field_force(run_.model, field, run_.bodies[field], body);
  run_.any_given = true;
  for (FieldContact& inside : in_field_) {
    if (inside.field == field && inside.body == body) {
      inside.seen = true;
      return;
    }
  }
  in_field_.push_back({field, body, true});
  run_.tell(EventKind::field_entered, field, body);
}

void FrameContacts::tell_fields_left() {
  for (const FieldContact& inside : in_field_) {
    if (!inside.seen) {
      run_.tell(EventKind::field_left, inside.field, inside.body);
    }
  }
  std::erase_if(in_field_, [](const FieldContact& inside) { return !inside.seen; });
  for (FieldContact& inside : in_field_) {
    inside.seen = false;
  }
}

void FrameContacts::FieldContact::persist(Archive& archive) { archive(field, body, seen); }
void FrameContacts::persist(Archive& archive) {
  archive(in_field_);
  for (const FieldContact& inside : in_field_) {
    archive.require(inside.field < run_.model.size() && inside.body < run_.model.size());
  }
}

}  // namespace core
}  // namespace kairos
