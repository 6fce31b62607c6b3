#include "core/forces/spring.hpp"

#include "core/forces/parameter.hpp"

#include <cassert>

namespace kairos {
inline namespace core {

Spring::Spring(const Parameters& parameters) : parameters_(parameters) {
  not_negative("stiffness", parameters.stiffness);
  not_negative("damping", parameters.damping);
  not_negative("rest_length", parameters.rest_length);
  finite("point_A", parameters.point_A);
  finite("point_B", parameters.point_B);
  finite("anchor_W", parameters.anchor_W);
}

Spring::Ends Spring::ends(std::span<const BodyState> bodies) const {
  assert(bodies.size() == 1 || bodies.size() == 2);
  const BodyState& first = bodies[0];
  Ends ends;
  ends.a = first.pose.to_world(parameters_.point_A);
  ends.rate = first.twist.at(ends.a, first.pose.position);
  if (bodies.size() == 2) {
    const BodyState& second = bodies[1];
    ends.b = second.pose.to_world(parameters_.point_B);
    ends.rate -= second.twist.at(ends.b, second.pose.position);
  } else {
    ends.b = parameters_.anchor_W;
  }
  return ends;
}

void Spring::add(Instant /*t*/, std::span<const BodyState> bodies,
                 std::span<Wrench> wrenches) const {
  const Ends ends = this->ends(bodies);
  const Vector3 distance = ends.a - ends.b;
  const double length = distance.norm();
  Vector3 force = -parameters_.stiffness * distance;
  if (length > 0.0) {
    const Vector3 n = distance / length;
    force +=
        (parameters_.stiffness * parameters_.rest_length - parameters_.damping * ends.rate.dot(n)) *
        n;
  }
  wrenches[0].force += force;
  wrenches[0].torque += (ends.a - bodies[0].pose.position).cross(force);
  if (bodies.size() == 2) {
    wrenches[1].force -= force;
    wrenches[1].torque -= (ends.b - bodies[1].pose.position).cross(force);
  }
}

double Spring::potential(Instant /*t*/, std::span<const BodyState> bodies) const {
  const Ends ends = this->ends(bodies);
  const double stretch = (ends.a - ends.b).norm() - parameters_.rest_length;
  return 0.5 * parameters_.stiffness * stretch * stretch;
}

}  // namespace core
}  // namespace kairos
