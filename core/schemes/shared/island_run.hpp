#pragma once

#include "core/scheme.hpp"
#include "core/schemes/shared/energy_account.hpp"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace kairos {
inline namespace core {

/// An island of a run, in either world: a copy of what the model says of it (fields, supports and
/// hands change what acts on it), its stepper, and where that has taken it.
struct IslandRun {
  /// Island `k` of the model; nothing is started yet.
  IslandRun(const Model& model, const Method& method, std::size_t k);

  /// Its states from those of all bodies.
  void gather(const State& bodies);
  /// Whether it moves in closed form now: steppers may give up, and that of a top is rounded to a
  /// polynomial, so that it is none for the ledger.
  [[nodiscard]] bool closed_form(const Model& model) const;
  /// Roundoff of the stepper's last step up to local time `s` (s), J: it led from `before` to
  /// `computed(place)`. Nothing where the step cannot be replayed.
  template <typename Computed>
  [[nodiscard]] std::optional<double> roundoff(double s, std::span<const BodyState> before,
                                               const Computed& computed) {
    replayed.resize(before.size());
    if (!stepper->replay(island, s, before, replayed)) {
      return std::nullopt;
    }
    double sum = 0.0;
    for (std::size_t k = 0; k < replayed.size(); ++k) {
      sum += roundoff_energy(island.inertia[k].mass, island.constant_force[k], computed(k),
                             replayed[k]);
    }
    return sum;
  }

  Island island;
  std::unique_ptr<Stepper> stepper;
  std::size_t number;                  ///< of the island, in the model
  bool carried = false;                ///< a hand holds its body: it has no steps of its own
  std::vector<BodyState> states;       ///< by place, at the end of what was computed
  JointProjection projection{};        ///< there
  std::vector<ReplayedStep> replayed;  ///< scratch
};

}  // namespace core
}  // namespace kairos
