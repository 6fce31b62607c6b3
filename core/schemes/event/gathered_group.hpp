#pragma once

#include "core/schemes/event/event_modes.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {

/// Speeds along the surface count as rest below this part of the speed that is rest along the
/// normal.
inline constexpr double still_part = 1e-3;

/// All that touches, at an instant, as bodies of the model and as a group.
struct EventModes::Gathered {
  std::vector<BodyIndex> bodies;  ///< by place in the group
  std::vector<BodyState> states;
  std::vector<std::pair<BodyIndex, BodyIndex>> pairs;  ///< by patch
  std::vector<char> passes;  ///< by patch: it strikes, or parts; it is known only to stay clear of
  ContactGroup group;
  double remaining = 0.0;  ///< until the accumulation is over that ends in this, s
  std::string refusal;
  std::string hangs;  ///< why it cannot go on without turning: some hang together
  std::vector<GroupMechanism> mechanisms;
  std::optional<BodyIndex> driven;  ///< one of those that are
  std::optional<BodyIndex> varies;  ///< one of those that feel forces which are not constant

  [[nodiscard]] std::size_t place(BodyIndex i) const {
    return static_cast<std::size_t>(std::find(bodies.begin(), bodies.end(), i) - bodies.begin());
  }
  [[nodiscard]] bool has(BodyIndex i) const { return place(i) < bodies.size(); }
  [[nodiscard]] bool presses(const BodyPair& pair, const FlatMode& mode) const {
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      if (pairs[p] == pair || pairs[p] == BodyPair{pair.second, pair.first}) {
        return mode.kept[p] != 0 && mode.pressing[p] > 0.0;
      }
    }
    return false;
  }
};

}  // namespace core
}  // namespace kairos
