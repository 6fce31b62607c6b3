#include "integrators/composite_stepper.hpp"

#include <algorithm>

namespace kairos::integrators {

void CompositeStepper::start(const Island& island, Instant t, std::span<const BodyState> states) {
  OdeStepper::start(island, t, states);
  y_.assign(ode_.size(), 0.0);
}

StepResult CompositeStepper::step(const Island& island, Instant t, double h,
                                  std::span<BodyState> states) {
  HermiteMotion::Node node = begin_step(island, t, states);
  double s = 0.0, error = 0.0;
  bool full = true;  // every part as long as asked for
  for (std::size_t k = 1; k <= substeps_ && s < h; ++k) {
    const double target = h * static_cast<double>(k) / static_cast<double>(substeps_);
    const double part = full ? target - s : std::min(h / static_cast<double>(substeps_), h - s);
    const Substep made = substep(s, part, node.y, node.rate, y_.data());
    if (!(made.advanced > 0.0)) {
      return {.advanced = 0.0, .error = made.error, .ok = false, .reason = failure_};
    }
    full = full && made.advanced == part;
    s = full ? target : std::min(s + made.advanced, h);
    error = std::max(error, made.error);
    node = dense_.add(s);
    std::copy(y_.begin(), y_.end(), node.y);
    finish_node(s, node);
  }
  end_step(states);
  return {.advanced = s, .error = error, .ok = true, .reason = {}};
}

}  // namespace kairos::integrators
