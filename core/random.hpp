#pragma once

#include "core/circular.hpp"
#include "core/exponential.hpp"
#include "core/pose.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace kairos {
inline namespace core {

/// Philox4x32-10: 128 random bits as a pure function of a counter and a key [Salmon2011, sec. 3].
/// Any draw of any stream can be made again from its seed and index alone.
[[nodiscard]] constexpr std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                                            std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t product_0 = std::uint64_t{0xD2511F53} * counter[0];
    const std::uint64_t product_1 = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(product_1 >> 32) ^ counter[1] ^ key[0],
               static_cast<std::uint32_t>(product_1),
               static_cast<std::uint32_t>(product_0 >> 32) ^ counter[3] ^ key[1],
               static_cast<std::uint32_t>(product_0)};
    key[0] += 0x9E3779B9;  // the golden ratio
    key[1] += 0xBB67AE85;  // sqrt(3) - 1
  }
  return counter;
}

/// Counter-based random numbers with distributions of our own: the standard library's differ
/// between platforms. `Random(seed, stream)` starts at index 0 of one of 2^64 independent streams.
class Random {
 public:
  /// Streams of one seed are independent; `index` is where in its stream it begins.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0, std::uint64_t index = 0)
      : seed_(seed), stream_(stream), index_(index) {}

  /// How many draws were made: with seed and stream, all that is needed to go on from here.
  [[nodiscard]] std::uint64_t index() const { return index_; }

  /// 64 random bits.
  std::uint64_t bits() {
    const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
    const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); };
    const auto block =
        philox({low(index_), high(index_), low(stream_), high(stream_)}, {low(seed_), high(seed_)});
    ++index_;
    return (std::uint64_t{block[1]} << 32) | block[0];
  }
  /// Uniform in [0, 1): multiples of 2^-53.
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  /// Uniform in [lowest, highest).
  double uniform(double lowest, double highest) { return lowest + (highest - lowest) * uniform(); }
  /// Uniform in the logarithm, lowest and highest > 0.
  double log_uniform(double lowest, double highest) {
    return lowest * exponential(uniform() * logarithm(highest / lowest));
  }
  /// Uniform in {0, ..., count - 1}, without bias; count > 0.
  std::uint64_t below(std::uint64_t count) {
    const std::uint64_t rest = (0 - count) % count;  // 2^64 mod count values are too many
    std::uint64_t x = bits();
    while (x < rest) {
      x = bits();
    }
    return x % count;
  }
  /// Standard normal: Box and Muller's transform; one draw of two is thrown away, so that every
  /// call takes two indices whatever came before.
  double normal() {
    const double radius = std::sqrt(-2.0 * logarithm(1.0 - uniform()));
    return radius * cosine(2.0 * std::numbers::pi * uniform());
  }
  /// Uniform on the unit sphere.
  Vector3 direction() {
    const double z = uniform(-1.0, 1.0);
    const double angle = 2.0 * std::numbers::pi * uniform();
    const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {radius * cosine(angle), radius * sine(angle), z};
  }
  /// Uniform over all orientations [Shoemake1992].
  Quaternion orientation() {
    const double u = uniform();
    const double a = 2.0 * std::numbers::pi * uniform();
    const double b = 2.0 * std::numbers::pi * uniform();
    const double p = std::sqrt(1.0 - u);
    const double q = std::sqrt(u);
    return Quaternion(q * cosine(b), p * sine(a), p * cosine(a), q * sine(b)).normalized();
  }

 private:
  std::uint64_t seed_;
  std::uint64_t stream_;
  std::uint64_t index_;
};

}  // namespace core
}  // namespace kairos
