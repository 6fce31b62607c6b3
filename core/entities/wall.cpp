#include "core/entity.hpp"
#include "core/scene.hpp"

namespace kairos {
inline namespace core {
namespace entities {
namespace {

/// 5.5, 6.3.1: an immovable surface. Mass -1 stands for infinite; what hits it is reflected in the
/// plane of its face (its `normal`); it takes nothing.
class Wall : public Entity {
 public:
  [[nodiscard]] std::string_view kind() const override { return "wall"; }
  [[nodiscard]] PhysicsType physics_type() const override { return PhysicsType::wall; }
  [[nodiscard]] Mobility mobility() const override { return Mobility::fixed; }
  [[nodiscard]] bool stationary() const override { return true; }
  [[nodiscard]] Momentum get_momentum(const Body& /*self*/,
                                      const BodyState& /*state*/) const override {
    return {};
  }
};

}  // namespace

EntityType wall() {
  return {.kind = "wall",
          .summary = "an immovable surface that reflects what hits it",
          .source = "5.5, 6.3.1",
          .mobility = Mobility::fixed,
          .keys = {},
          .make = [](std::span<const double>) { return std::make_shared<const Wall>(); }};
}

}  // namespace entities
}  // namespace core
}  // namespace kairos
