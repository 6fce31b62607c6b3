#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

namespace kairos::experiments {

/// What a query costs, ns; what the clock costs is taken off.
struct QueryCost {
  double mean = 0.0, median = 0.0, p99 = 0.0;
};

namespace query_cost {

using Clock = std::chrono::steady_clock;

inline double nanoseconds(Clock::duration time) {
  return std::chrono::duration<double, std::nano>(time).count();
}

/// What it costs to read the clock twice.
inline double of_clock() {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 1000; ++i) {
    const auto start = Clock::now();
    least = std::min(least, nanoseconds(Clock::now() - start));
  }
  return least;
}

}  // namespace query_cost

/// Times ask(i) for every i below `count`. The mean is from chunks, of each the least of all
/// rounds: short enough that some round is left alone by others. Median and 99 % are from each
/// query by itself, the least of all rounds too.
template <typename Ask>
QueryCost cost_of(std::size_t count, int rounds, const Ask& ask) {
  using query_cost::Clock;
  using query_cost::nanoseconds;
  constexpr std::size_t chunk_size = 64;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double clock = query_cost::of_clock();
  std::vector<double> each(count, infinity);
  std::vector<double> chunks((count + chunk_size - 1) / chunk_size, infinity);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t c = 0; c < chunks.size(); ++c) {
      const std::size_t last = std::min(count, (c + 1) * chunk_size);
      const auto start = Clock::now();
      for (std::size_t i = c * chunk_size; i < last; ++i) {
        ask(i);
      }
      chunks[c] = std::min(chunks[c], nanoseconds(Clock::now() - start) - clock);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const auto begin = Clock::now();
      ask(i);
      each[i] = std::min(each[i], nanoseconds(Clock::now() - begin) - clock);
    }
  }
  const auto quantile = [&each](double part) {
    const auto at =
        each.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(each.size() - 1));
    std::nth_element(each.begin(), at, each.end());
    return *at;
  };
  const double mean =
      std::accumulate(chunks.begin(), chunks.end(), 0.0) / static_cast<double>(count);
  const double median = quantile(0.5);
  return {mean, median, quantile(0.99)};
}

}  // namespace kairos::experiments
