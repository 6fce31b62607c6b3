#include "integrators/ode_stepper.hpp"

#include <algorithm>

namespace kairos::integrators {

void OdeStepper::start(const Island& island, Instant t, std::span<const BodyState> states) {
  ode_.layout(island);
  dense_.resize(nodes_, ode_.size());
  orientations_.resize(states.size());
  end_rate_.assign(ode_.size(), 0.0);
  restart(island, t, states);
}

void OdeStepper::restart(const Island& /*island*/, Instant /*t*/,
                         std::span<const BodyState> /*states*/) {
  has_end_rate_ = false;
}

HermiteMotion::Node OdeStepper::begin_step(const Island& island, Instant t,
                                           std::span<const BodyState> states) {
  // Every Runge-Kutta method of order 2 or more is exact there: its motion is the parabola.
  constant_acceleration_ = island.constant_acceleration() && !info().variable_order;
  for (std::size_t i = 0; i < states.size(); ++i) {
    orientations_[i] = states[i].pose.orientation;
  }
  ode_.bind(island, t);
  dense_.begin(t);
  const HermiteMotion::Node node = dense_.add(0.0);
  ode_.pack(states, node.y);
  if (has_end_rate_) {
    std::copy(end_rate_.begin(), end_rate_.end(), node.rate);
  } else {
    ode_.rhs(0.0, node.y, node.rate);
  }
  return node;
}

void OdeStepper::finish_node(double s, const HermiteMotion::Node& node) {
  ode_.normalize(node.y);
  ode_.rhs(s, node.y, node.rate);
}

void OdeStepper::end_step(std::span<BodyState> states) {
  const std::size_t last = dense_.nodes() - 1;
  std::copy_n(dense_.rate(last), ode_.size(), end_rate_.begin());
  has_end_rate_ = true;
  ode_.unpack(dense_.y(last), states);
}

void OdeStepper::dense_output(std::span<Motion> motions) const {
  dense_.motions(ode_, constant_acceleration_, orientations_, motions);
}

}  // namespace kairos::integrators
