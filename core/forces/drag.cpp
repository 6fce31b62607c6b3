#include "core/forces/drag.hpp"

#include "core/forces/parameter.hpp"

namespace kairos {
inline namespace core {

QuadraticDrag::QuadraticDrag(const Parameters& parameters)
    : coefficient_(0.5 * not_negative("density", parameters.density) *
                   not_negative("drag_coefficient", parameters.drag_coefficient) *
                   not_negative("area", parameters.area)),
      wind_(finite("wind", parameters.wind)) {}

void QuadraticDrag::add(Instant /*t*/, std::span<const BodyState> bodies,
                        std::span<Wrench> wrenches) const {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Vector3 u = bodies[i].twist.linear - wind_;
    wrenches[i].force -= coefficient_ * u.norm() * u;
  }
}

double QuadraticDrag::potential(Instant /*t*/, std::span<const BodyState> /*bodies*/) const {
  return 0.0;
}

LinearDrag::LinearDrag(const Parameters& parameters) : parameters_(parameters) {
  not_negative("coefficient", parameters.coefficient);
  not_negative("rotational", parameters.rotational);
  finite("wind", parameters.wind);
}

void LinearDrag::add(Instant /*t*/, std::span<const BodyState> bodies,
                     std::span<Wrench> wrenches) const {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Twist& twist = bodies[i].twist;
    wrenches[i].force -= parameters_.coefficient * (twist.linear - parameters_.wind);
    wrenches[i].torque -= parameters_.rotational * twist.angular;
  }
}

double LinearDrag::potential(Instant /*t*/, std::span<const BodyState> /*bodies*/) const {
  return 0.0;
}

}  // namespace core
}  // namespace kairos
