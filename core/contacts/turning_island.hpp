#pragma once

#include "core/contacts/turning_way.hpp"
#include "core/force.hpp"

#include <deque>
#include <memory>

namespace kairos {
inline namespace core {

/// What of a group a stepper integrates: its free bodies, and what acts on them. Contact forces are
/// the last of it, but for the forces of joints.
class TurningIsland {
 public:
  explicit TurningIsland(const TurningWay& way);
  TurningIsland(const TurningIsland&) = delete;
  TurningIsland& operator=(const TurningIsland&) = delete;

  [[nodiscard]] const Island& island() const { return island_; }

 private:
  Island island_;
  std::deque<std::unique_ptr<const Force>> forces_;
};

}  // namespace core
}  // namespace kairos
