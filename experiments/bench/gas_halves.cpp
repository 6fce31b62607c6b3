#include "experiments/bench/gas_halves.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <thread>

namespace kairos::experiments {

void GasHalves::event(const Event& event) {
  if (event.kind != EventKind::impact) {
    return;
  }
  constexpr double middle = 0.5;  // m: the room is a cube of 1 m, a corner at the origin
  ++impacts_;
  const bool wall =
      event.before_a.twist.linear.isZero(0.0) || event.before_b.twist.linear.isZero(0.0);
  const bool right_a = event.before_a.pose.position.x() > middle;
  const bool right_b = event.before_b.pose.position.x() > middle;
  if (wall || right_a == right_b) {
    ++(event.contact.point.x() > middle ? right_ : left_);
    return;
  }
  ++across_;
  one_after_another_ += std::max(left_, right_) + 1;
  left_ = right_ = 0;
}

double GasHalves::speedup(double impact, double hand_over) const {
  const auto alone = static_cast<double>(one_after_another_ + std::max(left_, right_));
  const double two = alone * impact + static_cast<double>(across_) * hand_over;
  return static_cast<double>(impacts_) * impact / two;
}

double hand_over_seconds() {
  constexpr int rounds = 5;
  constexpr int turns = 20'000;
  using Clock = std::chrono::steady_clock;
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round < rounds; ++round) {
    std::atomic<int> turn = 0;
    std::jthread other([&turn] {
      for (int k = 1; k < 2 * turns; k += 2) {
        while (turn.load(std::memory_order_acquire) != k) {
        }
        turn.store(k + 1, std::memory_order_release);
      }
    });
    const auto start = Clock::now();
    for (int k = 0; k < 2 * turns; k += 2) {
      while (turn.load(std::memory_order_acquire) != k) {
      }
      turn.store(k + 1, std::memory_order_release);
    }
    other.join();
    const double took = std::chrono::duration<double>(Clock::now() - start).count();
    least = std::min(least, took / turns);
  }
  return least;
}

}  // namespace kairos::experiments
