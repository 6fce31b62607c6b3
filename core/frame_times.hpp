#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kairos {
inline namespace core {

/// All frames take the same time.
struct FixedFrames {
  double duration = 1.0 / 60.0;  ///< s
};
/// Durations read from a file, s; after the last one they start again.
struct ListedFrames {
  std::vector<double> durations;
  std::string path;
};
/// A rendered frame does not take the same time every time: mean * (1 + jitter * u), u uniform in
/// [-1, 1], and with probability `spike_probability` a stall of `spike_factor` frames.
struct JitteredFrames {
  double mean = 1.0 / 60.0;  ///< s
  double jitter = 0.0;       ///< in [0, 1)
  double spike_probability = 0.0;
  double spike_factor = 10.0;
  std::uint64_t seed = 1;
};

/// How long rendered frames take.
using FrameTimes = std::variant<FixedFrames, ListedFrames, JitteredFrames>;

/// Duration of frame n (from 0), s: a pure function of n, so that any frame can be asked for.
[[nodiscard]] double frame_duration(const FrameTimes& times, std::int64_t n);
/// Mean duration, s.
[[nodiscard]] double mean_frame_duration(const FrameTimes& times);

}  // namespace core
}  // namespace kairos
