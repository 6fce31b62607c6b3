#include "experiments/cli/run_progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace kairos::experiments {

RunProgress::~RunProgress() { fmt::print(stderr, "\r\033[K"); }

void RunProgress::begin(const Model& /*model*/) { draw(0.0); }

void RunProgress::frame(const Frame& frame) { reach(frame.time); }

void RunProgress::event(const Event& event) {
  ++events_;
  reach(event.time);
}

void RunProgress::reach(Instant t) {
  const Clock::time_point now = Clock::now();
  if (now - drawn_ > std::chrono::milliseconds(100)) {
    drawn_ = now;
    draw(t.seconds);
  }
}

void RunProgress::draw(double t) const {
  constexpr double width = 24.0;
  const double share = std::clamp(end_ > 0.0 ? t / end_ : 1.0, 0.0, 1.0);
  const auto filled = static_cast<std::size_t>(width * share);
  const double elapsed = std::chrono::duration<double>(drawn_ - start_).count();
  const double rate = elapsed > 0.0 ? static_cast<double>(events_) / elapsed : 0.0;
  fmt::print(stderr, "\r\033[Krun [{:#<{}}{:.<{}}] {:.4g} of {:.4g} s, {} events, {:.3g} a second",
             "", filled, "", static_cast<std::size_t>(width) - filled, t, end_, events_, rate);
  if (share > 0.0 && share < 1.0) {
    fmt::print(stderr, ", {:.0f} s left", elapsed * (1.0 - share) / share);
  }
  std::fflush(stderr);
}

}  // namespace kairos::experiments
