#pragma once

#include "experiments/bench/chunk_race.hpp"

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace kairos::experiments {

/// Of a time of impact: none.
inline constexpr double never = std::numeric_limits<double>::infinity();

/// How the results of a race are told.
struct Telling {
  std::string measure;             ///< whose time is that of the last column, if it runs
  double accuracy = 1e-4;          ///< an answer above the proven one by more is late
  std::string late = "late";       ///< what that is called
  std::size_t chunk = long_chunk;  ///< see `race_in_chunks`
};

/// Runs a race, prints it against the answers of its first racer, which are proven, and returns the
/// results.
std::vector<RaceResult> tell(const std::string& title, const std::vector<Racer>& racers,
                             std::size_t count, int rounds, const Telling& telling);

/// The time of one over that of another; not a number if one of them does not run.
[[nodiscard]] double ratio(std::span<const RaceResult> results, const std::string& name,
                           const std::string& than);

/// What was measured beside what it is to stay below.
struct Bar {
  std::string what;
  double value = 0.0;  ///< not finite: there is nothing to compare with
  double at_most = 0.0;
};
/// One line each: met, or by how much not.
void print_bars(std::span<const Bar> bars);

}  // namespace kairos::experiments
