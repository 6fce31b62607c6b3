#include "core/entity.hpp"
#include "core/scene.hpp"

namespace kairos {
inline namespace core {
namespace entities {
namespace {

/// What 13.8 takes for an interval of 0 s, so that it can divide.
constexpr double shortest_interval = 1e-8;

/// 7.2, 7.3: a bat in a tracked hand. It gives its mass and its velocity and takes nothing.
class Bat : public Entity {
 public:
  Bat(double threshold, double velocity_scale, const Nudge& nudge)
      : threshold_(threshold), velocity_scale_(velocity_scale), nudge_(nudge) {}

  [[nodiscard]] std::string_view kind() const override { return "bat"; }
  [[nodiscard]] PhysicsType physics_type() const override { return PhysicsType::ttbat; }
  [[nodiscard]] Mobility mobility() const override { return Mobility::driven; }
  [[nodiscard]] Nudge nudge() const override { return nudge_; }
  [[nodiscard]] Momentum get_momentum(const Body& self, const BodyState& state) const override {
    return {self.mass, state.twist.linear};
  }

  /// 13.8: the displacement since the last accepted sample, divided by the last interval alone;
  /// renewed only when that displacement exceeds the threshold, kept otherwise, also after the hand
  /// has stopped. What the first sample does is our reading: it is accepted, at velocity zero.
  [[nodiscard]] Vector3 tracked_velocity(TrackerMemory& memory, const BodyState& truth,
                                         double interval) const override {
    if (!memory.primed) {
      memory = {true, truth.pose.position, Vector3::Zero()};
      return memory.velocity;
    }
    const Vector3 moved = truth.pose.position - memory.accepted_position;
    if (moved.norm() > threshold_) {
      const double divisor = interval == 0.0 ? shortest_interval : interval;
      memory.velocity = velocity_scale_ * (moved / divisor);
      memory.accepted_position = truth.pose.position;
    }
    return memory.velocity;
  }

 private:
  double threshold_;       // m
  double velocity_scale_;  // 7.3: empirical
  Nudge nudge_;            // 7.4
};

}  // namespace

EntityType bat() {
  return {.kind = "bat",
          .summary = "follows a tracker or an analytic motion and hits what is in its way",
          .source = "7.2-7.4, 13.8, 13.9",
          .mobility = Mobility::driven,
          .keys = {{"velocity_threshold", "m", 0.01, 0.0, 1e12,
                    "displacement that renews the velocity estimated from positions"},
                   {"velocity_scale", "", 1.0, 0.0, 1e6, "empirical factor of that velocity"},
                   {"nudge", "s", 0.0, 0.0, 1e3,
                    "a ball that it hits is moved by nudge * scale * (v' - v); 0.0025 in 13.9"},
                   {"nudge_prose", "s", 0.0, 0.0, 1e3,
                    "the same along v', as the prose of 7.4 has it"}},
          .make = [](std::span<const double> values) {
            return std::make_shared<const Bat>(values[0], values[1], Nudge{values[2], values[3]});
          }};
}

}  // namespace entities
}  // namespace core
}  // namespace kairos
