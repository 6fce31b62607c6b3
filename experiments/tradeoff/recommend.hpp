#pragma once

#include "experiments/tradeoff/assessment.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kairos::experiments {

/// What a person needs of a simulation.
struct Requirements {
  double error = 0.0;                      ///< m, of any free body at the end; > 0
  std::optional<double> penetration = {};  ///< m, deepest in a drawn frame
  std::optional<double> budget = {};  ///< s of work per second of the scene's frames, see below
};

/// A budget of time is held against counted work, so that the answer is the same each time: one
/// counted operation is taken for this long, s. Of the machine on which it was set (2026, one core)
/// most methods need less: `kairos tradeoff` measures.
inline constexpr double nominal_operation = 1e-7;

/// Why a method does not do; empty if it does.
[[nodiscard]] std::string shortcoming(const Assessed& method, const Reference& reference,
                                      const Requirements& wanted, double frame);

/// What a method does beyond the compared part, over the whole run: how deep bodies get into each
/// other, or that it does not come to its end. Empty text: no fault of it.
using WholeRun = std::function<std::string(const Assessed&)>;
/// Runs a method over the whole duration of the reference and looks at what `wanted` says of its
/// depth; where it says nothing, nothing may be deeper than half the smallest body: it would be
/// through.
[[nodiscard]] WholeRun whole_run_of(const Model& model, const Reference& reference,
                                    const Requirements& wanted);

struct Recommendation {
  std::string refused;  ///< why nothing can be advised, whatever the methods do; empty: it can
  std::optional<std::size_t> pick;  ///< into `Assessment::methods`: the least work of those that do
  std::vector<std::size_t> ranked;  ///< all, by counted work, then by name
  std::vector<std::string> shortcomings;  ///< of each method; empty: it does
};

/// Ranks by counted work. `frame`: of the scene, s. Methods that meet the bounds where they were
/// compared are held to `whole` too, cheapest first, until one passes. Nothing is advised where the
/// compared part shows less than what happens in the whole run.
[[nodiscard]] Recommendation recommend(const Assessment& assessment, const Requirements& wanted,
                                       double frame, const WholeRun& whole);

}  // namespace kairos::experiments
