#include "experiments/parallel_for.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <latch>
#include <memory>
#include <mutex>
#include <new>
#include <system_error>

namespace kairos::experiments {

std::size_t default_threads() {
  return std::max<std::size_t>(1, std::thread::hardware_concurrency());
}

std::vector<std::jthread> start_threads(std::size_t count, const std::function<void()>& work) {
  // Stacks must not take what the work itself needs: this is kept free until all have started, and
  // none works before. It is too little for an allocator's arena, which only one thread would use.
  // Its pages are never touched: to fill them took longer than to answer a thousand queries.
  constexpr std::size_t reserve = std::size_t{48} << 20;  // bytes
  const auto started = std::make_shared<std::latch>(1);
  std::vector<std::jthread> threads;
  try {
    std::vector<char> kept;
    kept.reserve(count > 0 ? reserve : 0);
    threads.reserve(count);
    for (std::size_t t = 0; t < count; ++t) {
      threads.emplace_back([started, work] {
        started->wait();
        work();
      });
    }
  } catch (const std::system_error&) {
    // The system has no more to give, in threads or in memory: those that there are do the work.
  } catch (const std::bad_alloc&) {
  }
  started->count_down();
  return threads;
}

void parallel_for(std::size_t count, std::size_t threads,
                  const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto worker = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = failure ? failure : std::current_exception();
        next = count;
      }
    }
  };
  const std::size_t wanted = std::min(threads == 0 ? default_threads() : threads, count);
  {
    const std::vector<std::jthread> others = start_threads(wanted == 0 ? 0 : wanted - 1, worker);
    worker();
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
}

}  // namespace kairos::experiments
