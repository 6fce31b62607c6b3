#pragma once

#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

namespace kairos::experiments {

/// Number of threads that `threads = 0` stands for: one per core.
[[nodiscard]] std::size_t default_threads();

/// Calls `work(i)` once for every i in [0, count), on `threads` threads (0: one per core), and
/// returns when all are done. Each call must write only what belongs to its i: results are then
/// the same whatever the number of threads. Workers take the next index when they are free, so
/// that runs of different length balance. The first exception ends the loop and is rethrown.
void parallel_for(std::size_t count, std::size_t threads,
                  const std::function<void(std::size_t)>& work);

/// Starts so many threads, or as many as the system gives: the caller works too. They are joined
/// when the vector goes; what `work` throws ends the program.
[[nodiscard]] std::vector<std::jthread> start_threads(std::size_t count,
                                                      const std::function<void()>& work);

}  // namespace kairos::experiments
