#pragma once

#include "core/contacts/turning_forces.hpp"

#include <optional>
#include <vector>

namespace kairos {
inline namespace core {

/// What ends sliding that no finite forces go with.
struct Jam {
  std::vector<Twist> velocities;  ///< by body
  std::vector<char> struck;       ///< by touch: it took an impulse
  bool tangential = false;        ///< nothing approached: an impact at no speed
  double driven = 0.0;            ///< work of what joints hang on in that, J
};

/// An impulse that changes how bodies in touch slide, where no forces are known. Nothing else than:
/// - in Painleve's case: friction presses what slides together the more the more it presses. Forces
///   grow beyond all bounds at once, which is an impact at no speed (a tangential impact
///   [Genot1999]);
/// - where friction is infinite, and what is pressed slides: the same;
/// - where they approach, too slowly for a hop worth the name: an impact without rebound.
/// Impulses are within the cones of friction, against what still slides afterwards, and none where
/// they part [Moreau1988]: kinetic energy never grows, whatever they are. They are looked for touch
/// by touch, again and again; nothing where that does not settle. `still`: what slides slower than
/// this, m/s, sticks. `halvings`: the most that is done for it is halved so many times.
[[nodiscard]] std::optional<Jam> jam(const TurningState& state, double still, int halvings = 0);

}  // namespace core
}  // namespace kairos
