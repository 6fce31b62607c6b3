#include "experiments/metric_impacts.hpp"

namespace kairos::experiments {

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
    (normal_velocity(event.contact, event.before_a, event.before_b) > 0.0 ? separating_
                                                                          : approaching_) += 1;
  }
}

}  // namespace kairos::experiments
