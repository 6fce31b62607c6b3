#pragma once

#include "core/contacts/flat_modes.hpp"
#include "core/model.hpp"

#include <span>
#include <string>
#include <vector>

namespace kairos {
inline namespace core {

/// Guards that act within this part of an epoch act at once.
inline constexpr double at_once = 1e-12;

/// Until when the patches of a group carry it, by patch, within `duration`, s: a ball's centre, a
/// vertex, or the centre of pressure of two faces comes to the rim of one of them. Exact: motions
/// are parabolas, and so is the way of a centre of pressure where the rest of the group hangs on
/// one patch. Infinite where nothing does. Returns why that cannot be told; empty: it was.
[[nodiscard]] std::string guard_times(const Model& model, std::span<const BodyIndex> bodies,
                                      std::span<const BodyState> states, const ContactGroup& group,
                                      const FlatMode& mode, double duration,
                                      std::vector<double>& until);

}  // namespace core
}  // namespace kairos
