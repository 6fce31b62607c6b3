#pragma once

#include "core/instant.hpp"
#include "core/pose.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace kairos {
inline namespace core {

/// A ball on a parabola: its motion as far as it matters, where many are asked about.
struct BallFlight {
  Vector3 position = Vector3::Zero();      ///< at `start`, m
  Vector3 velocity = Vector3::Zero();      ///< at `start`, m/s
  Vector3 acceleration = Vector3::Zero();  ///< m/s^2
  Instant start;
  double radius = 0.0;  ///< error radius included, m
};

/// Balls beside one of them, component by component, as a loop over wide registers reads them.
class FlightsBeside {
 public:
  /// In each `Block`: a multiple of what a register holds.
  static constexpr std::size_t block = 32;
  /// Some of the balls; what is beyond `size()` are numbers of no meaning.
  struct Block {
    using Column = std::array<double, block>;  ///< one of each ball
    std::array<Column, 3> position{};          ///< at their starts, m
    std::array<Column, 3> velocity{};          ///< there, m/s
    Column lag{};                              ///< how much later than the one they start, s
    Column radius{};                           ///< error radius included, m
    Column comparable{};                       ///< 1: accelerated as the one is; else 0
  };

  /// None, beside this one.
  void begin(const BallFlight& one) {
    one_ = &one;
    size_ = 0;
    alike_ = false;
  }
  /// The same, and all that come are as large as the one, and accelerated as it is.
  void begin_alike(const BallFlight& one) {
    begin(one);
    alike_ = true;
  }
  /// One more.
  void add(const BallFlight& other) {
    const std::size_t k = size_ % block;
    add_alike(other);
    Block& to = blocks_[(size_ - 1) / block];
    to.radius[k] = other.radius;
    to.comparable[k] = one_->acceleration == other.acceleration ? 1.0 : 0.0;
  }

  /// One more that is as large as the one, and accelerated as it is.
  void add_alike(const BallFlight& other) {
    add_alike(
        1, [&other](std::size_t /*k*/) -> const BallFlight& { return other; },
        [](std::size_t /*k*/) { return true; });
  }
  /// Of so many of that kind those that `takes(k)`: `thrown(k)` has position, velocity and start of
  /// one. It is asked for all of them, of which some may be of another kind.
  template <typename Thrown, typename Takes>
  void add_alike(std::size_t count, const Thrown& thrown, const Takes& takes) {
    const Instant start = one_->start;
    for (std::size_t done = 0; done < count;) {
      const std::size_t number = size_ / block;
      if (number == blocks_.size()) {
        blocks_.emplace_back();
      }
      Block& to = blocks_[number];
      std::size_t k = size_ % block;
      for (const std::size_t end = done + std::min(block - k, count - done); done < end; ++done) {
        // Each is written, and some are written over: which ones, no processor would guess.
        const auto& other = thrown(done);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          to.position[axis][k] = other.position.data()[axis];
          to.velocity[axis][k] = other.velocity.data()[axis];
        }
        to.lag[k] = other.start - start;
        k += takes(done) ? 1 : 0;
      }
      size_ = number * block + k;
    }
  }

  /// Whether what is told of their radii and of how they are accelerated is that of the one.
  [[nodiscard]] bool alike() const { return alike_; }
  /// How many there are.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Beside whom.
  [[nodiscard]] const BallFlight& one() const { return *one_; }
  /// All of them, and perhaps more.
  [[nodiscard]] std::span<const Block> blocks() const { return blocks_; }
  /// How much later than the one ball k starts, s.
  [[nodiscard]] double lag(std::size_t k) const { return blocks_[k / block].lag[k % block]; }

 private:
  const BallFlight* one_ = nullptr;
  bool alike_ = false;
  std::size_t size_ = 0;
  std::vector<Block> blocks_;  ///< as many as there have had to be
};

}  // namespace core
}  // namespace kairos
