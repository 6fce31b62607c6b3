#pragma once

#include "core/event.hpp"
#include "simulation/simulate.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

namespace kairos::tests {

/// The events of one kind, in order of time.
[[nodiscard]] inline std::vector<Event> of_kind(const Trajectory& trajectory, EventKind kind) {
  std::vector<Event> found;
  std::copy_if(trajectory.events().begin(), trajectory.events().end(), std::back_inserter(found),
               [kind](const Event& event) { return event.kind == kind; });
  return found;
}

}  // namespace kairos::tests
