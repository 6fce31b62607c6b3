#pragma once

#include "core/drives/track.hpp"

#include <string>
#include <vector>

namespace kairos {
inline namespace core {

/// A recording as read.
struct Recording {
  std::vector<TrackSample> samples;
  bool gestures = false;  ///< it has the column `gesture`
};

/// Reads a recording (columns t, x, y, z, qw, qx, qy, qz, gesture; SI units; gesture is 1 for a
/// closed fist and 0 for an open hand; the quaternion columns may be left out together, and so may
/// the gesture). Throws `InputError`.
[[nodiscard]] Recording read_track_csv(const std::string& path);

}  // namespace core
}  // namespace kairos
