#include "core/schemes/shared/island_run.hpp"

#include <cassert>

namespace kairos {
inline namespace core {

IslandRun::IslandRun(const Model& model, const Method& method, std::size_t k)
    : island(model.islands()[k]),
      stepper(method.stepper(model, k)),
      number(k),
      states(island.bodies.size()) {
  assert(!island.bodies.empty() && island.inertia.size() == states.size());
}

void IslandRun::gather(const State& bodies) {
  for (std::size_t k = 0; k < states.size(); ++k) {
    states[k] = bodies[island.bodies[k]];
  }
}

bool IslandRun::closed_form(const Model& model) const {
  return stepper->info().order == 0 && !model.tumbles(number);
}

}  // namespace core
}  // namespace kairos
