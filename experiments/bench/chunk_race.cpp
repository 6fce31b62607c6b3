#include "experiments/bench/chunk_race.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

#ifdef __linux__
#include <sched.h>
#endif

namespace kairos::experiments {
namespace {

/// The core that this thread runs on is its only one while this lives.
class PinnedToOneCore {
 public:
#ifdef __linux__
  PinnedToOneCore() {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(std::max(0, sched_getcpu())), &one);
    known_ = sched_getaffinity(0, sizeof before_, &before_) == 0;
    sched_setaffinity(0, sizeof one, &one);
  }
  ~PinnedToOneCore() {
    if (known_) {
      sched_setaffinity(0, sizeof before_, &before_);
    }
  }

 private:
  cpu_set_t before_{};
  bool known_ = false;
#else
  PinnedToOneCore() = default;
  ~PinnedToOneCore() = default;
#endif
 public:
  PinnedToOneCore(const PinnedToOneCore&) = delete;
  PinnedToOneCore& operator=(const PinnedToOneCore&) = delete;
};

}  // namespace

std::vector<RaceResult> race_in_chunks(std::span<const Racer> racers, std::size_t count, int rounds,
                                       std::size_t chunk) {
  using Clock = std::chrono::steady_clock;
  const PinnedToOneCore pinned;
  std::vector<RaceResult> results;
  for (const Racer& racer : racers) {
    results.push_back({racer.name, 0.0, std::vector<double>(count)});
  }
  std::vector<double> least(racers.size());
  for (std::size_t first = 0; first < count; first += chunk) {
    const std::size_t last = std::min(count, first + chunk);
    std::fill(least.begin(), least.end(), std::numeric_limits<double>::infinity());
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t i = 0; i < racers.size(); ++i) {
        const auto start = Clock::now();
        racers[i].contest(first, last, results[i].answers);
        const std::chrono::duration<double, std::nano> time = Clock::now() - start;
        least[i] = std::min(least[i], time.count());
      }
    }
    for (std::size_t i = 0; i < racers.size(); ++i) {
      results[i].nanoseconds += least[i] / static_cast<double>(count);
    }
  }
  return results;
}

}  // namespace kairos::experiments
