#include "experiments/bench/bench.hpp"

#include <fmt/format.h>

#include <chrono>
#include <limits>

namespace kairos::experiments {

std::vector<Timing> race(const std::vector<Contender>& contenders, int rounds) {
  using Clock = std::chrono::steady_clock;
  std::vector<Timing> timings;
  for (const Contender& contender : contenders) {
    timings.push_back({contender.name, std::numeric_limits<double>::infinity(), 0});
  }
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      const auto start = Clock::now();
      const std::int64_t units = contenders[i].work();
      const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
      const double each = 1e9 * seconds / static_cast<double>(units > 0 ? units : 1);
      timings[i].units = units;
      timings[i].nanoseconds = each < timings[i].nanoseconds ? each : timings[i].nanoseconds;
    }
  }
  return timings;
}

void print_race(const std::string& title, const std::string& unit,
                const std::vector<Timing>& timings) {
  fmt::print("{}\n  {:<44}{:>14}{:>16}{:>10}{:>12}\n", title, "", "ns per " + unit, "million a s",
             "ratio", "of");
  for (const Timing& timing : timings) {
    fmt::print("  {:<44}{:>14.1f}{:>16.3f}{:>10.2f}{:>12}\n", timing.name, timing.nanoseconds,
               1e3 / timing.nanoseconds, timing.nanoseconds / timings.front().nanoseconds,
               timing.units);
  }
}

}  // namespace kairos::experiments
