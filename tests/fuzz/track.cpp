// A tracker recording: any text is either refused with a reason, or a track that can be followed.
#include "core/drives/track.hpp"

#include "core/error.hpp"
#include "core/reading/track_reader.hpp"
#include "tests/fuzz/fuzz_target.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

using namespace kairos;
using kairos::fuzz::require;

namespace {

/// The reader takes a path: one file, written again for every input.
std::string write_input(const std::uint8_t* data, std::size_t size) {
  static const std::string path = (std::filesystem::temp_directory_path() /
                                   ("kairos-fuzz-track-" + std::to_string(::getpid()) + ".csv"))
                                      .string();
  std::FILE* file = std::fopen(path.c_str(), "wb");
  require(file != nullptr && std::fwrite(data, 1, size, file) == size, "cannot write the input");
  std::fclose(file);
  return path;
}

Track::Options options(bool smooth) {
  Track::Options made;
  made.smooth = smooth;
  return made;
}

void follow(const Track& track) {
  for (const TrackSample& sample : track.samples()) {
    const Motion motion = track.motion(Instant{} + std::max(sample.time, 0.0), 1.0);
    require(motion.duration > 0.0, "a motion has no length");
    const Pose pose = motion.pose(0.0);
    require(std::isfinite(pose.position.sum()), "a position is not finite");
    require(std::abs(pose.orientation.norm() - 1.0) < 1e-9, "an orientation is not unit");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = write_input(data, size);
  try {
    Recording recording = read_track_csv(path);
    require(!recording.samples.empty(), "a recording has no samples");
    follow(Track(recording.samples, options(false)));
    follow(Track(std::move(recording.samples), options(true)));
  } catch (const InputError& error) {
    require(!error.reason().empty(), "a recording is refused without a reason");
  }
  std::remove(path.c_str());
  return 0;
}
