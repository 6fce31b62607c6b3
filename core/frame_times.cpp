#include "core/frame_times.hpp"

#include "core/random.hpp"

#include <numeric>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

/// Streams of the random numbers of jittered frames.
constexpr std::uint64_t jitter_stream = 0;
constexpr std::uint64_t spike_stream = 1;

double duration_of(const FixedFrames& frames, std::int64_t) { return frames.duration; }

double duration_of(const ListedFrames& frames, std::int64_t n) {
  const auto count = static_cast<std::int64_t>(frames.durations.size());
  return frames.durations[static_cast<std::size_t>(n % count)];
}

double duration_of(const JitteredFrames& frames, std::int64_t n) {
  const auto index = static_cast<std::uint64_t>(n);
  const double u = Random(frames.seed, jitter_stream, index).uniform(-1.0, 1.0);
  const bool spike = Random(frames.seed, spike_stream, index).uniform() < frames.spike_probability;
  return frames.mean * (1.0 + frames.jitter * u) * (spike ? frames.spike_factor : 1.0);
}

double mean_of(const FixedFrames& frames) { return frames.duration; }

double mean_of(const ListedFrames& frames) {
  return std::accumulate(frames.durations.begin(), frames.durations.end(), 0.0) /
         static_cast<double>(frames.durations.size());
}

double mean_of(const JitteredFrames& frames) {
  return frames.mean * (1.0 + frames.spike_probability * (frames.spike_factor - 1.0));
}

}  // namespace

double frame_duration(const FrameTimes& times, std::int64_t n) {
  return std::visit([n](const auto& frames) { return duration_of(frames, n); }, times);
}

double mean_frame_duration(const FrameTimes& times) {
  return std::visit([](const auto& frames) { return mean_of(frames); }, times);
}

}  // namespace core
}  // namespace kairos
