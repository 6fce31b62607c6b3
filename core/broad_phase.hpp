#pragma once

#include "core/motion.hpp"
#include "core/shape.hpp"
#include "core/state.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

/// Axis-aligned box, world frame, m.
struct Aabb {
  Vector3 lower = Vector3::Zero();
  Vector3 upper = Vector3::Zero();

  /// Whether the two boxes have a point in common.
  [[nodiscard]] bool overlaps(const Aabb& other) const {
    return (lower.array() <= other.upper.array()).all() &&
           (other.lower.array() <= upper.array()).all();
  }
};

/// Port: which bodies could touch this one? Holds one box per body, the box its shape sweeps
/// over the motion it is registered with.
class BroadPhase {
 public:
  virtual ~BroadPhase() = default;
  /// Its name in the registry.
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Registers or moves a body; `swept` contains its shape during its current motion.
  virtual void update(BodyIndex body, const Aabb& swept) = 0;
  /// Appends every registered body, other than `body`, whose box could overlap that of `body`.
  /// Order: ascending index, so that runs do not depend on how boxes are stored.
  virtual void candidates(BodyIndex body, std::vector<BodyIndex>& out) const = 0;
  /// The same for a box that belongs to no body; in any order.
  virtual void overlapping(const Aabb& box, std::vector<BodyIndex>& out) const = 0;
  /// Forgets a body, if it is registered.
  virtual void remove(BodyIndex body) = 0;
};

}  // namespace core
}  // namespace kairos
