#pragma once

#include "core/contacts/turning_step.hpp"

#include <span>
#include <vector>

namespace kairos {
inline namespace core {

/// A group on its way through a step: where its bodies are, and what its touches do there.
struct TurningWay {
  TurningWay(const TurningGroup& of, const TurningMode& in, Instant start);

  /// s after the start of the step.
  [[nodiscard]] std::vector<BodyState> free_states(double s) const;
  [[nodiscard]] TurningState at(double s) const;
  /// As its touches see it: without loads and joints.
  [[nodiscard]] TurningState touching_at(double s) const;

  const TurningGroup& group;
  const TurningMode& mode;
  Instant t;
  double slow;                     ///< see `slow_slip`, m/s
  std::vector<std::size_t> free;   ///< places of free bodies
  std::vector<Motion> motions;     ///< theirs
  std::vector<std::size_t> carry;  ///< which rays of cones carried the load when asked last
};

/// The group at another instant as its touches see it: without loads and joints.
[[nodiscard]] TurningState touching_state(const TurningGroup& group, Instant t,
                                          std::span<const BodyState> free_states);

/// Its touches there.
[[nodiscard]] std::vector<TouchNow> touches_of(const TurningState& state);

/// What touches do, with directions of sliding as they are there.
[[nodiscard]] std::vector<FrictionChoice> directed(const TurningMode& mode,
                                                   const std::vector<TouchNow>& now, double slow);

/// Slower than this, m/s, what slides goes on as it did: a small part of what a body gains that
/// falls by its size. Directions of slower sliding change faster than steps can follow.
[[nodiscard]] double slow_slip(const TurningGroup& group);

/// Forces of an implicit step: they go with the normals, and are as large as they were.
[[nodiscard]] std::vector<Vector3> carried_forces(const TurningGroup& group,
                                                  const TurningMode& mode,
                                                  const std::vector<TouchNow>& now);

}  // namespace core
}  // namespace kairos
