#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

namespace kairos::experiments {

/// How far long work has come, on stderr: a bar on a terminal, nothing in a pipe. Thread-safe.
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
  void show(std::size_t done);
  void draw() const;
  [[nodiscard]] bool due() const;

  std::string label_;
  std::size_t total_;
  std::size_t done_ = 0;
  bool terminal_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
  std::mutex mutex_;
};

}  // namespace kairos::experiments
