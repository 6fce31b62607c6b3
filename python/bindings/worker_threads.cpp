#include "python/bindings/worker_threads.hpp"

#include <algorithm>
#include <atomic>
#include <system_error>
#include <thread>
#include <vector>

namespace kairos::python {

void in_pieces(std::size_t count, std::size_t threads,
               const std::function<void(std::size_t, std::size_t)>& work,
               const std::function<void()>& look) {
  constexpr std::size_t piece = 256;
  std::atomic<std::size_t> next{0};
  const auto take = [&](bool caller) {
    for (std::size_t first = next.fetch_add(piece); first < count; first = next.fetch_add(piece)) {
      work(first, std::min(first + piece, count));
      if (caller) {
        look();
      }
    }
  };
  const std::size_t cores = std::max<std::size_t>(1, std::thread::hardware_concurrency());
  const std::size_t wanted = std::min(threads == 0 ? cores : threads, (count + piece - 1) / piece);
  std::vector<std::jthread> others;
  try {
    for (std::size_t i = 1; i < wanted; ++i) {
      others.emplace_back([&take] { take(false); });
    }
  } catch (const std::system_error&) {
    // The system gives no more: those that there are do the work.
  }
  try {
    take(true);
  } catch (...) {
    next = count;
    throw;
  }
}

}  // namespace kairos::python
