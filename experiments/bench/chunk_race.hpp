#pragma once

#include "experiments/bench/bench_peers.hpp"

#include <cstddef>
#include <span>

namespace kairos::experiments {

/// One of several that answer the same pairs.
struct Racer {
  std::string name;
  Contest contest;
};

struct RaceResult {
  std::string name;
  double nanoseconds = 0.0;     ///< per pair
  std::vector<double> answers;  ///< as of `Contest`
};

/// How many queries are timed at once: of short ones enough that the clock costs nothing.
inline constexpr std::size_t long_chunk = std::size_t{1} << 12U;

/// Lets all answer `count` pairs, `chunk` by `chunk` in turn and `rounds` times over, pinned to one
/// core where the system allows it: what disturbs the machine disturbs all of them. Of every chunk
/// the least time is kept: disturbances only ever add.
[[nodiscard]] std::vector<RaceResult> race_in_chunks(std::span<const Racer> racers,
                                                     std::size_t count, int rounds,
                                                     std::size_t chunk = long_chunk);

}  // namespace kairos::experiments
