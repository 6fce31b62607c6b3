#include "experiments/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace kairos::experiments {

ProgressBar::ProgressBar(std::string label, std::size_t total)
    : label_(std::move(label)),
      total_(total),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      drawn_(start_) {
  if (terminal_) {
    draw();  // the first piece of work may take long
  }
}

ProgressBar::~ProgressBar() {
  if (terminal_) {
    fmt::print(stderr, "\r\033[K");
  }
}

void ProgressBar::advance() {
  const std::lock_guard lock(mutex_);
  show(done_ + 1);
}

void ProgressBar::reach(std::size_t done) {
  const std::lock_guard lock(mutex_);
  show(done);
}

void ProgressBar::show(std::size_t done) {
  done_ = done;
  if (due() || (terminal_ && done_ == total_)) {
    drawn_ = std::chrono::steady_clock::now();
    draw();
  }
}

bool ProgressBar::due() const {
  return terminal_ && std::chrono::steady_clock::now() - drawn_ > std::chrono::milliseconds(100);
}

void ProgressBar::draw() const {
  constexpr std::size_t width = 30;
  const std::size_t filled = total_ == 0 ? width : width * done_ / total_;
  const double elapsed = std::chrono::duration<double>(drawn_ - start_).count();
  const double left =
      elapsed * static_cast<double>(total_ - done_) / static_cast<double>(done_ == 0 ? 1 : done_);
  fmt::print(stderr, "\r\033[K{} [{:#<{}}{:.<{}}] {}/{} {:.0f} s left", label_, "", filled, "",
             width - filled, done_, total_, left);
  std::fflush(stderr);
}

}  // namespace kairos::experiments
