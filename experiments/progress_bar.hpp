#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>

namespace kairos::experiments {

/// How far long work has come, on stderr: a bar on a terminal, nothing in a pipe. Thread-safe.
/// The bar is drawn five times a second whether or not anything gets done: one piece may take long.
class ProgressBar {
 public:
  ProgressBar(std::string label, std::size_t total);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  /// Clears the line.
  ~ProgressBar();

  /// One more is done.
  void advance();
  /// So many are done.
  void reach(std::size_t done);
  /// Whether anybody sees it.
  [[nodiscard]] bool is_drawn() const { return drawer_.joinable(); }
  /// One of those at work has come so far, 0 to 1; of pieces that may take long.
  void reach_within(double share) { within_.store(share, std::memory_order_relaxed); }

 private:
  void draw_until(const std::stop_token& stop);
  void draw() const;

  std::string label_;
  std::size_t total_;
  std::size_t done_ = 0;
  std::atomic<double> within_ = 0.0;
  std::chrono::steady_clock::time_point start_;
  std::mutex mutex_;
  std::condition_variable_any stopped_;
  std::jthread drawer_;
};

}  // namespace kairos::experiments
