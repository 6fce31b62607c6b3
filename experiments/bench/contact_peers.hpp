#pragma once

#include "core/state.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace kairos::experiments {

/// What `bench contact` lets kairos and its peers do, with the same bodies: 1 kg each, G = 9.8,
/// gravity along -y, friction 0.5, no restitution, nothing sleeps.
struct ContactTask {
  enum class Kind { stack, chain };
  Kind kind = Kind::stack;
  int bodies = 10;
  std::int64_t steps = 600;
  double frame = 1.0 / 60.0;  ///< s

  /// Half extents, m: of a box of the stack, of a link of the chain.
  [[nodiscard]] Vector3 half() const {
    return kind == Kind::stack ? Vector3(0.25, 0.25, 0.25) : Vector3(0.25, 0.05, 0.05);
  }
  /// Where body i is at t = 0: on the others, or beside them in a row that hangs on the origin.
  [[nodiscard]] Vector3 place(int i) const {
    return kind == Kind::stack ? Vector3(0.0, 0.25 + 0.5 * i, 0.0)
                               : Vector3(0.25 + 0.5 * i, 0.0, 0.0);
  }
};

/// A library that was found when kairos was built; it does a task and tells where its bodies end.
struct ContactPeer {
  std::string name;
  std::function<std::vector<BodyState>(const ContactTask&)> run;
};

/// Bullet, ODE and Box2D with what they come with, those that were found.
[[nodiscard]] std::vector<ContactPeer> bullet_contact_peers();
[[nodiscard]] std::vector<ContactPeer> ode_contact_peers();
[[nodiscard]] std::vector<ContactPeer> box2d_contact_peers();

}  // namespace kairos::experiments
