#include "core/csv.hpp"
#include "core/document.hpp"
#include "core/drives/track.hpp"
#include "core/error.hpp"
#include "core/scene_limits.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kairos {
inline namespace core {
namespace {

constexpr std::string_view columns[] = {"t", "x", "y", "z", "qw", "qx", "qy", "qz"};
constexpr std::size_t columns_without_orientation = 4;

/// Whether the header, the first line that says anything, names a quaternion column.
bool has_orientation(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    if (!line.empty() && line.front() != '#') {
      return line.find('q') != std::string_view::npos;
    }
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return false;
}

Quaternion orientation(const CsvNumbers& csv, std::size_t i, const std::string& path) {
  const Eigen::Vector4d q(csv(i, 4), csv(i, 5), csv(i, 6), csv(i, 7));
  const double norm = q.stableNorm();
  if (!(std::abs(norm - 1.0) <= limits::quaternion_norm)) {
    throw InputError(path, csv.line(i), "qw,qx,qy,qz",
                     fmt::format("has norm {}; allowed: a unit quaternion, norm within {} of 1",
                                 norm, limits::quaternion_norm));
  }
  return Quaternion(q[0], q[1], q[2], q[3]).normalized();
}

}  // namespace

std::vector<TrackSample> read_track_csv(const std::string& path) {
  const std::string text = read_text_file(path);
  const bool oriented = has_orientation(text);
  const CsvNumbers csv(
      path, text,
      std::span(columns).first(oriented ? std::size(columns) : columns_without_orientation));
  if (csv.size() == 0) {
    throw InputError(path, 0, "", "has no samples; needed: at least one");
  }
  std::vector<TrackSample> samples;
  for (std::size_t i = 0; i < csv.size(); ++i) {
    const auto checked = [&](std::size_t column, const Range& range) {
      const double x = csv(i, column);
      if (!range.contains(x)) {
        throw InputError(path, csv.line(i), std::string(columns[column]),
                         fmt::format("is {}; allowed: {}", x, range.text()));
      }
      return x;
    };
    TrackSample sample;
    sample.time = checked(0, {.lowest = -1e12, .highest = 1e12, .unit = "s"});
    sample.pose.position = {checked(1, limits::position), checked(2, limits::position),
                            checked(3, limits::position)};
    if (oriented) {
      sample.pose.orientation = orientation(csv, i, path);
    }
    // Samples closer than a nanosecond are typing errors, and would ask for infinite speeds.
    if (!samples.empty() && !(sample.time - samples.back().time >= 1e-9)) {
      throw InputError(
          path, csv.line(i), "t",
          fmt::format("is {} after {}; allowed: times that increase by at least 1e-9 s",
                      sample.time, samples.back().time));
    }
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace core
}  // namespace kairos
