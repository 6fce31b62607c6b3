#pragma once

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

 private:
  void draw_until(const std::stop_token& stop);
  void draw() const;

  std::string label_;
  std::size_t total_;
  std::size_t done_ = 0;
  std::chrono::steady_clock::time_point start_;
  std::mutex mutex_;
  std::condition_variable_any stopped_;
  std::jthread drawer_;
};

}  // namespace kairos::experiments
