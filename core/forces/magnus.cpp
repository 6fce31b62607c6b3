#include "core/forces/magnus.hpp"

#include "core/exponential.hpp"
#include "core/forces/parameter.hpp"

#include <numbers>

namespace kairos {
inline namespace core {

MagnusLift::MagnusLift(const Parameters& parameters)
    : coefficient_(0.5 * not_negative("density", parameters.density) *
                   not_negative("lift_coefficient", parameters.lift_coefficient) *
                   std::numbers::pi * power(not_negative("radius", parameters.radius), 3)),
      wind_(finite("wind", parameters.wind)) {}

void MagnusLift::add(Instant /*t*/, std::span<const BodyState> bodies,
                     std::span<Wrench> wrenches) const {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Twist& twist = bodies[i].twist;
    wrenches[i].force += coefficient_ * twist.angular.cross(twist.linear - wind_);
  }
}

double MagnusLift::potential(Instant /*t*/, std::span<const BodyState> /*bodies*/) const {
  return 0.0;
}

}  // namespace core
}  // namespace kairos
