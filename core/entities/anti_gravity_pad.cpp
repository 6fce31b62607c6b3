#include "core/entity.hpp"
#include "core/scene.hpp"

namespace kairos {
inline namespace core {
namespace entities {
namespace {

/// 5.8, 6.3.1, 6.5: things that enter its well feel twice its G upwards, so that they fall up. It
/// has mass -1, stops nothing, and takes nothing.
class AntiGravityPad : public Entity {
 public:
  [[nodiscard]] std::string_view kind() const override { return "anti-gravity-pad"; }
  [[nodiscard]] PhysicsType physics_type() const override { return PhysicsType::agpad; }
  [[nodiscard]] Mobility mobility() const override { return Mobility::fixed; }
  [[nodiscard]] bool is_field() const override { return true; }
  [[nodiscard]] Momentum get_momentum(const Body& /*self*/,
                                      const BodyState& /*state*/) const override {
    return {};
  }
  [[nodiscard]] Vector3 get_force(const Body& self, const BodyState& /*state*/) const override {
    return {0.0, 2.0 * self.G, 0.0};
  }
};

}  // namespace

EntityType anti_gravity_pad() {
  return {.kind = "anti-gravity-pad",
          .summary = "a region where things feel twice the pad's G upwards; nothing bounces off it",
          .source = "5.8, 6.5",
          .mobility = Mobility::fixed,
          .keys = {},
          .make = [](std::span<const double>) { return std::make_shared<const AntiGravityPad>(); }};
}

}  // namespace entities
}  // namespace core
}  // namespace kairos
