#pragma once

#include "experiments/random/random_scene.hpp"

namespace kairos::experiments {

/// Whether two half-spaces, of which something drives one at least, come so near to each other
/// between these times, s, that a body of the scene has no room between them however it is turned:
/// a ball, or a box on its smallest side. Nothing that is rigid goes on there. By the scene's own
/// numbers: the judge of runs that stopped.
[[nodiscard]] bool leaves_no_room(const RandomScene& scene, double from, double until);

}  // namespace kairos::experiments
