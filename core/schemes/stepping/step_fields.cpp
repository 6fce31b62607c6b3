#include "core/schemes/stepping/step_fields.hpp"

#include <algorithm>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

void tell(SchemeRun& run, const State& bodies, EventKind kind, BodyIndex a, BodyIndex b) {
  Event event{.time = run.time, .kind = kind, .a = a, .b = b};
  event.before_a = event.after_a = bodies[a];
  event.before_b = event.after_b = bodies[b];
  run.note(event);
}

}  // namespace

void StepFields::act(SchemeRun& run, const State& bodies, std::vector<Vector3>& given) {
  std::fill(given.begin(), given.end(), Vector3::Zero());
  const Model& model = run.model;
  for (const auto& [a, b] : model.pairs()) {
    if (!model.is_field(a) && !model.is_field(b)) {
      continue;
    }
    const auto [field, body] = model.is_field(a) ? std::pair{a, b} : std::pair{b, a};
    if (!model.is_free(body)) {
      continue;
    }
    ++run.cost.overlap_tests;
    if (run.detector.overlaps(model.shape(a), bodies[a].pose, model.shape(b), bodies[b].pose)) {
      given[body] += field_force(model, field, bodies[field], body);
      if (note(field, body)) {
        tell(run, bodies, EventKind::field_entered, field, body);
      }
    }
  }
  for (const Inside& inside : inside_) {
    if (!inside.seen) {
      tell(run, bodies, EventKind::field_left, inside.field, inside.body);
    }
  }
  std::erase_if(inside_, [](const Inside& inside) { return !inside.seen; });
  for (Inside& inside : inside_) {
    inside.seen = false;
  }
}

/// Notes that the body is in the field; returns whether it was not before.
bool StepFields::note(BodyIndex field, BodyIndex body) {
  for (Inside& inside : inside_) {
    if (inside.field == field && inside.body == body) {
      inside.seen = true;
      return false;
    }
  }
  inside_.push_back({field, body, true});
  return true;
}

void StepFields::Inside::persist(Archive& archive) { archive(field, body, seen); }

void StepFields::persist(Archive& archive, std::size_t bodies) {
  archive(inside_);
  for (const Inside& inside : inside_) {
    archive.require(inside.field < bodies && inside.body < bodies);
  }
}

}  // namespace core
}  // namespace kairos
