#include "core/forces/buoyancy.hpp"

#include "core/forces/parameter.hpp"

namespace kairos {
inline namespace core {

Buoyancy::Buoyancy(const Parameters& parameters)
    : force_(-not_negative("density", parameters.density) *
             not_negative("volume", parameters.volume) * finite("gravity", parameters.gravity)),
      centre_B_(finite("centre_B", parameters.centre_B)) {}

void Buoyancy::add(Instant /*t*/, std::span<const BodyState> bodies,
                   std::span<Wrench> wrenches) const {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Vector3 arm = bodies[i].pose.orientation * centre_B_;
    wrenches[i].force += force_;
    wrenches[i].torque += arm.cross(force_);
  }
}

double Buoyancy::potential(Instant /*t*/, std::span<const BodyState> bodies) const {
  double sum = 0.0;
  for (const BodyState& body : bodies) {
    sum -= force_.dot(body.pose.to_world(centre_B_));
  }
  return sum;
}

}  // namespace core
}  // namespace kairos
