#include "core/entity.hpp"
#include "core/rotation_between.hpp"
#include "core/scene.hpp"

namespace kairos {
inline namespace core {
namespace entities {
namespace {

/// 5.7, 6.3.3, 13.6: a surface whose belt runs along the body's +x axis. What that does is up to
/// the impact law.
///
/// `thesis`: reflects as a wall does and gives a push along its length; the thesis gives mass 10
/// and a speed of 1. For balls lighter than the belt the exchange formula has already turned the
/// normal velocity outwards and the reflection turns it back in.
///
/// `newton`: without friction nothing acts along the surface: the belt runs on underneath, carries
/// nothing, has no mass, and what hits it meets a wall. With friction it carries, at its speed
/// whatever it takes.
///
/// A half-space has a normal in place of an orientation: its belt runs along what +x becomes when
/// +y is turned to the normal.
class Conveyor : public Entity {
 public:
  Conveyor(double belt_mass, double belt_speed) : belt_mass_(belt_mass), belt_speed_(belt_speed) {}

  [[nodiscard]] std::string_view kind() const override { return "conveyor"; }
  [[nodiscard]] PhysicsType physics_type() const override { return PhysicsType::conveyor; }
  [[nodiscard]] Mobility mobility() const override { return Mobility::fixed; }
  [[nodiscard]] bool stationary() const override { return true; }
  [[nodiscard]] Momentum get_momentum(const Body& self, const BodyState& state) const override {
    return {belt_mass_, state.pose.orientation * (belt_speed_ * along(self))};
  }
  [[nodiscard]] Vector3 surface_velocity(const Body& self, const BodyState& state) const override {
    return get_momentum(self, state).velocity;
  }

 private:
  /// Direction of the belt, body frame.
  static Vector3 along(const Body& self) {
    const auto* half_space = std::get_if<HalfSpace>(&self.shape);
    return half_space == nullptr ? Vector3(Vector3::UnitX())
                                 : rotation_between(Vector3::UnitY(), half_space->normal_B) *
                                       Vector3(Vector3::UnitX());
  }

  double belt_mass_;   // kg
  double belt_speed_;  // m/s
};

}  // namespace

EntityType conveyor() {
  return {.kind = "conveyor",
          .summary =
              "a surface whose belt runs along the body's +x axis: pushes under thesis, a wall "
              "under newton",
          .source = "5.7, 6.3.3, 13.6",
          .mobility = Mobility::fixed,
          .keys = {{"belt_mass", "kg", 10.0, 1e-30, 1e30,
                    "mass that the belt exchanges with, under thesis"},
                   {"belt_speed", "m/s", 1.0, -1e12, 1e12, "speed of the belt along +x"}},
          .make = [](std::span<const double> values) {
            return std::make_shared<const Conveyor>(values[0], values[1]);
          }};
}

}  // namespace entities
}  // namespace core
}  // namespace kairos
