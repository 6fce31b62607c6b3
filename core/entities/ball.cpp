#include "core/entities/ball.hpp"

#include "core/scene.hpp"

namespace kairos {
inline namespace core {
namespace entities {
namespace {

/// The velocity mirrored in the plane with this unit normal, whichever way it points: a reflection
/// does not ask whether the two approach (the jiggle of ch. 9).
Vector3 reflected(const Vector3& velocity, const Vector3& normal) {
  return velocity - 2.0 * velocity.dot(normal) * normal;
}

/// 6.4: the elastic exchange of two masses, applied to whole vectors.
Vector3 exchanged(double mass, const Vector3& velocity, const Momentum& other) {
  const double sum = mass + other.mass;
  return (mass - other.mass) / sum * velocity + 2.0 * other.mass / sum * other.velocity;
}

}  // namespace

Momentum Ball::get_momentum(const Body& self, const BodyState& state) const {
  return {self.mass, state.twist.linear};
}

void Ball::give_momentum(const Body& self, BodyState& state, const Gift& gift) const {
  const Vector3 before = state.twist.linear;
  Vector3 after = before;
  if (gift.from == PhysicsType::wall) {
    if (gift.normal) {
      after = reflected(before, *gift.normal);
    }
  } else if (gift.momentum.mass != -1.0) {
    after = exchanged(self.mass, before, gift.momentum);
    if (gift.normal) {
      after = reflected(after, *gift.normal);
    }
  }
  state.twist.linear = after;
  // 13.9: out of the bat's way, along the change of velocity (line 20 of 13.7 has taken the
  // difference before line 28 uses it) or along the new velocity (the prose of 7.4).
  if (!gift.nudge.none()) {
    state.pose.position += self.scale * (gift.nudge.along_change * (after - before) +
                                         gift.nudge.along_velocity * after);
  }
}

void Ball::give_force(Vector3& net_force, const Vector3& force) const { net_force += force; }

EntityType ball() {
  return {.kind = "ball",
          .summary = "falls, bounces off surfaces, exchanges momentum; nothing turns it",
          .source = "5.6, 6.4.1, 13.7",
          .mobility = Mobility::free,
          .keys = {},
          .make = [](std::span<const double>) { return std::make_shared<const Ball>(); }};
}

}  // namespace entities
}  // namespace core
}  // namespace kairos
