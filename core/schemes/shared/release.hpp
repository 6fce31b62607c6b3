#pragma once

#include "core/schemes/shared/grasps.hpp"
#include "core/schemes/shared/scheme_run.hpp"

#include <functional>
#include <string>

namespace kairos {
inline namespace core {

/// Why a body that a hand has held cannot have contacts again at time t: it is inside a solid, and
/// no scheme can tell what follows; empty if it can. Both are named, and how deep. Asked when the
/// hand lets go of it, and when it is clear of the hand. The hand itself, and what is in other
/// hands, do not count. `pose`: where a body is now.
///
/// Tolerance (roundoff): 16 eps times the coordinates and extents is touching.
[[nodiscard]] std::string why_not_released(const SchemeRun& run, const Grasps& grasps,
                                           const Grip& grip, Instant t,
                                           const std::function<Pose(BodyIndex)>& pose);

}  // namespace core
}  // namespace kairos
