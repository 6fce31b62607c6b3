#pragma once

#include "core/contacts/flat_modes.hpp"
#include "core/model.hpp"

#include <span>
#include <string>
#include <vector>

namespace kairos {
inline namespace core {

class EventRun;

/// Guards that act within this part of an epoch act at once.
inline constexpr double at_once = 1e-12;

/// Two bodies that touch at one place.
struct TouchingPair {
  BodyIndex a = 0;
  BodyIndex b = 0;
  Vector3 normal = Vector3::Zero();  ///< unit, from a to b, world
  Vector3 at = Vector3::Zero();      ///< world, m
};

/// A body while it is guarded.
struct Moving {
  const Motion& motion;  ///< without its turning
  bool spins = false;    ///< it turns about the normal, or rolls
};

/// When two bodies that slide along each other from t on, within `duration` (s), meet elsewhere,
/// too: with what of a mesh or compound rises above the plane in which they touch, of which the
/// detector is not asked while they touch. Brings `until` (s from t) forward to that; returns why
/// they cannot go on, if they meet at once.
[[nodiscard]] std::string meets_elsewhere(const EventRun& run, const TouchingPair& pair,
                                          const Moving& a, const Moving& b, Instant t,
                                          double duration, double& until);

/// Until when the patches of a group carry it, by patch, within `duration`, s: a ball's centre, a
/// vertex, or the centre of pressure of two faces comes to the rim of one of them, or both meet
/// elsewhere, too. Exact: motions
/// are parabolas, and so is the way of a centre of pressure where the rest of the group hangs on
/// one patch. Infinite where nothing does. Returns why that cannot be told; empty: it was.
[[nodiscard]] std::string guard_times(const EventRun& run, std::span<const BodyIndex> bodies,
                                      std::span<const BodyState> states, const ContactGroup& group,
                                      const FlatMode& mode, double duration,
                                      std::vector<double>& until);

}  // namespace core
}  // namespace kairos
