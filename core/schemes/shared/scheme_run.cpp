#include "core/schemes/shared/scheme_run.hpp"

#include <algorithm>
#include <cassert>
#include <tuple>

namespace kairos {
inline namespace core {

SchemeRun::SchemeRun(const Model& of, const Method& method, const SchemeOptions& asked,
                     Recorder& to)
    : model(of),
      detector(*method.detector),
      law(*method.law),
      options(asked),
      recorder(to),
      wants_motions(to.wants_motions()),
      mean_frame(mean_frame_duration(asked.frames)),
      account(of, ledger) {
  recorder.begin(of);
}

ImpactEnergy SchemeRun::exchange(Event& event, BodyState& a, BodyState& b, Vector3& force_a,
                                 Vector3& force_b, bool flat) {
  assert(event.a != event.b);
  event.before_a = a;
  event.before_b = b;
  event.contact.restitution = model.restitution(event.a, event.b);
  event.contact.friction = model.friction(event.a, event.b);
  const BodyInertia inertia_a = flat ? flat_inertia(event.a) : model.inertia(event.a);
  const BodyInertia inertia_b = flat ? flat_inertia(event.b) : model.inertia(event.b);
  const ImpactBody body_a{model.body(event.a), inertia_a, a, force_a};
  const ImpactBody body_b{model.body(event.b), inertia_b, b, force_b};
  const ImpactEnergy energy = law.apply(event.contact, body_a, body_b);
  event.after_a = a;
  event.after_b = b;
  if (options.roundoff) {
    ledger.add(EnergyLine::roundoff,
               law.roundoff(event.contact, body_a, body_b, event.before_a, event.before_b));
  }
  for (const auto& [i, before, after] : {std::tuple{event.a, &event.before_a, &event.after_a},
                                         std::tuple{event.b, &event.before_b, &event.after_b}}) {
    if (!model.is_free(i)) {
      continue;
    }
    account.struck(i, *before, *after);
    if (after->pose.position != before->pose.position) {
      account.moved(i, after->pose.position - before->pose.position);
    }
  }
  ++cost.impacts;
  note(event);
  return energy;
}

void SchemeRun::struck(const Event& event, const PlainBall* a, const PlainBall* b) {
  if (a != nullptr) {
    account.struck(*a, event.before_a, event.after_a);
  }
  if (b != nullptr) {
    account.struck(*b, event.before_b, event.after_b);
  }
  ++cost.impacts;
  note(event);
}

BodyInertia SchemeRun::flat_inertia(BodyIndex i) const {
  BodyInertia inertia = model.inertia(i);
  inertia.rotates = inertia.rotates && std::holds_alternative<Sphere>(model.shape(i));
  return inertia;
}

void SchemeRun::note(const Event& event) {
  ++cost.events;
  if (!boxes_crossed.empty()) {
    tell(as_recorded(event));
  } else {
    tell(event);
  }
}

void SchemeRun::tell(const Event& event) {
  if (holds_events_) {
    held_events_.push_back(event);
  } else {
    recorder.event(event);
  }
}

Event SchemeRun::as_recorded(Event event) const {
  event.contact.point += recorded_offset(event.a);
  event.before_a.pose.position += recorded_offset(event.a);
  event.after_a.pose.position += recorded_offset(event.a);
  event.before_b.pose.position += recorded_offset(event.b);
  event.after_b.pose.position += recorded_offset(event.b);
  return event;
}

void SchemeRun::tell_held_events() {
  std::stable_sort(held_events_.begin(), held_events_.end(),
                   [](const Event& a, const Event& b) { return a.time < b.time; });
  for (const Event& event : held_events_) {
    recorder.event(event);
  }
  held_events_.clear();
  holds_events_ = false;
}

RunResult SchemeRun::result(State&& state) && {
  return {stopped() ? RunStatus::stopped : RunStatus::completed,
          std::move(why_stopped_),
          time,
          std::move(state),
          ledger,
          cost};
}

}  // namespace core
}  // namespace kairos
