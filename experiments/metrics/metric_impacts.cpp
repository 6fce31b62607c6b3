#include "experiments/metrics/metric_impacts.hpp"

#include "core/impact_law.hpp"
#include "simulation/registry.hpp"

namespace kairos::experiments {

ImpactWatch::ImpactWatch(const Model& model, BodyIndex body)
    : model_(model), detector_(find_detector("sat")), body_(body) {}

/// The thesis' law asks for no contact normal; then it is found from the poses.
Contact ImpactWatch::contact_of(const Event& event) const {
  if (!event.contact.normal.isZero()) {
    return event.contact;
  }
  const Overlap overlap = detector_->overlap(model_.shape(event.a), event.before_a.pose,
                                             model_.shape(event.b), event.before_b.pose);
  return {overlap.point, overlap.normal, overlap.gap};
}

void ImpactWatch::event(const Event& event) {
  if (event.a != body_ && event.b != body_) {
    return;
  }
  if (event.kind == EventKind::contact_begins) {
    rest_ = rest_ ? rest_ : event.time.seconds;
  } else if (event.kind == EventKind::contact_ends) {
    rest_.reset();
  } else if (event.kind == EventKind::impact) {
    first_ = first_ ? first_ : event.time.seconds;
    last_ = event.time.seconds;
    (normal_velocity(contact_of(event), event.before_a, event.before_b) > 0.0 ? separating_
                                                                              : approaching_) += 1;
  }
}

}  // namespace kairos::experiments
