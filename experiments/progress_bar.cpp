#include "experiments/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace kairos::experiments {

ProgressBar::ProgressBar(std::string label, std::size_t total)
    : label_(std::move(label)), total_(total), start_(std::chrono::steady_clock::now()) {
  if (isatty(STDERR_FILENO) == 1) {
    drawer_ = std::jthread([this](const std::stop_token& stop) { draw_until(stop); });
  }
}

ProgressBar::~ProgressBar() {
  if (drawer_.joinable()) {
    drawer_.request_stop();
    drawer_.join();
    fmt::print(stderr, "\r\033[K");
  }
}

void ProgressBar::advance() {
  const std::lock_guard lock(mutex_);
  ++done_;
}

void ProgressBar::reach(std::size_t done) {
  const std::lock_guard lock(mutex_);
  done_ = done;
}

void ProgressBar::draw_until(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    draw();
    stopped_.wait_for(lock, stop, std::chrono::milliseconds(200), [] { return false; });
  }
}

void ProgressBar::draw() const {
  constexpr std::size_t width = 30;
  const std::size_t filled = total_ == 0 ? width : width * done_ / total_;
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const auto done = static_cast<double>(done_);
  const std::string time =
      done_ == 0
          ? fmt::format("{:.0f} s so far", elapsed)
          : fmt::format("{:.0f} s left", elapsed * (static_cast<double>(total_) - done) / done);
  const double within = within_.load(std::memory_order_relaxed);
  const std::string piece = within > 0.0 && done_ < total_
                                ? fmt::format(", one at {:.2g} % of its way", 100.0 * within)
                                : "";
  fmt::print(stderr, "\r\033[K{} [{:#<{}}{:.<{}}] {}/{}{} {}", label_, "", filled, "",
             width - filled, done_, total_, piece, time);
  std::fflush(stderr);
}

}  // namespace kairos::experiments
