#pragma once

#include "core/entity.hpp"

namespace kairos {
inline namespace core {
namespace entities {

/// 5.6, 6.4.1: the one thing of the thesis that moves by itself. Its `give_momentum` holds all of
/// the thesis' collision intelligence; bodies and balloons inherit it.
class Ball : public Entity {
 public:
  [[nodiscard]] std::string_view kind() const override { return "ball"; }
  [[nodiscard]] PhysicsType physics_type() const override { return PhysicsType::ball; }
  [[nodiscard]] Mobility mobility() const override { return Mobility::free; }
  /// 6.3.2: its mass and its velocity.
  [[nodiscard]] Momentum get_momentum(const Body& self, const BodyState& state) const override;
  /// 13.7 and 13.9.
  void give_momentum(const Body& self, BodyState& state, const Gift& gift) const override;
  /// 6.6: adds any force to its net force.
  void give_force(Vector3& net_force, const Vector3& force) const override;
};

}  // namespace entities
}  // namespace core
}  // namespace kairos
