#pragma once

#include "experiments/tradeoff/assessment.hpp"

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

struct Recommendation {
  std::optional<std::size_t> pick;  ///< into `Assessment::methods`: the least work of those that do
  std::vector<std::size_t> ranked;  ///< all, by counted work, then by name
  std::vector<std::string> shortcomings;  ///< of each method; empty: it does
};

/// Ranks by counted work. `frame`: of the scene, s.
[[nodiscard]] Recommendation recommend(const Assessment& assessment, const Requirements& wanted,
                                       double frame);

}  // namespace kairos::experiments
