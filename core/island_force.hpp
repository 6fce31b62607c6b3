#pragma once

#include "core/force.hpp"

#include <memory>
#include <string>
#include <vector>

namespace kairos {
inline namespace core {

/// A force that acts on some bodies of an island: shows them to the force in the force's order.
class IslandForce : public Force {
 public:
  /// Most bodies that one force can couple: what `add` keeps on the stack.
  static constexpr std::size_t most_bodies = 8;

  /// `places`: where in the island each body of the force is.
  IslandForce(std::shared_ptr<const Force> force, std::vector<std::size_t> places);

  void add(Instant t, std::span<const BodyState> bodies, std::span<Wrench> wrenches) const override;
  [[nodiscard]] double potential(Instant t, std::span<const BodyState> bodies) const override;
  [[nodiscard]] bool conservative() const override { return force_->conservative(); }
  [[nodiscard]] bool involves_rotation() const override { return force_->involves_rotation(); }
  [[nodiscard]] std::string description() const override { return force_->description(); }

 private:
  std::shared_ptr<const Force> force_;
  std::vector<std::size_t> places_;
};

}  // namespace core
}  // namespace kairos
