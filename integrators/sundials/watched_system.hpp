#pragma once

#include "core/gap_function.hpp"
#include "integrators/sundials/island_system.hpp"

#include <memory>
#include <vector>

namespace kairos::integrators::sundials {

/// An `IslandSystem` whose gaps CVODE watches. What its rootfinding sees are changes of sign from
/// the beginning of a step to its end: a gap that touches zero and opens again, or closes and opens
/// within one step, is missed [Hindmarsh2005].
struct WatchedSystem : IslandSystem {
  std::shared_ptr<const GapFunction> gaps;
  Instant epoch;                  ///< of the solver's time 0
  std::vector<BodyState> states;  ///< scratch

  /// What the solver is to be given as user data.
  [[nodiscard]] void* self() { return static_cast<IslandSystem*>(this); }

  static int gap(Real t, N_Vector y, Real* out, void* self) {
    auto& system = static_cast<WatchedSystem&>(*static_cast<IslandSystem*>(self));
    system.ode->unpack(data(y), system.states);
    const std::span<double> gaps(out, system.gaps->size());
    system.gaps->evaluate(system.epoch + t, system.states, gaps);
    for (double& value : gaps) {
      // CVODE multiplies two of them to see a change of sign: the product must not underflow.
      value = value == 0.0 ? 0.0 : std::copysign(std::max(std::abs(value), 1e-150), value);
    }
    return 0;
  }

  /// Has a solver that has been created watch the gaps, if there are any, for contacts that begin:
  /// falling through zero.
  void watch(void* solver, std::span<const BodyState> bodies) {
    states.assign(bodies.begin(), bodies.end());
    if (!gaps || gaps->size() == 0) {
      return;
    }
    const auto count = static_cast<int>(gaps->size());
    std::vector<int> falling(gaps->size(), -1);
    CVodeRootInit(solver, count, gap);
    CVodeSetRootDirection(solver, falling.data());
    CVodeSetNoInactiveRootWarn(solver);
  }
};

}  // namespace kairos::integrators::sundials
