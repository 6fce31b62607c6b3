#include "core/reading/track_reader.hpp"

#include "core/error.hpp"
#include "core/reading/csv.hpp"
#include "core/reading/document.hpp"
#include "core/reading/scene_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kairos {
inline namespace core {
namespace {

constexpr std::string_view place[] = {"t", "x", "y", "z"};
constexpr std::string_view turn[] = {"qw", "qx", "qy", "qz"};
constexpr std::string_view gesture = "gesture";

/// Whether the header, the first line that says anything, names the column.
bool has_column(std::string_view text, std::string_view column) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = trimmed(text.substr(0, end));
    if (line.starts_with("\xEF\xBB\xBF")) {
      line.remove_prefix(3);  // byte order mark
    }
    if (!line.empty() && line.front() != '#') {
      while (true) {
        const std::size_t comma = line.find(',');
        if (trimmed(line.substr(0, comma)) == column) {
          return true;
        }
        if (comma == std::string_view::npos) {
          return false;
        }
        line.remove_prefix(comma + 1);
      }
    }
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return false;
}

/// The columns of this recording, in the order in which they are read: place, turn, gesture.
std::vector<std::string_view> columns_of(std::string_view text) {
  std::vector<std::string_view> columns(std::begin(place), std::end(place));
  if (std::any_of(std::begin(turn), std::end(turn),
                  [&](std::string_view column) { return has_column(text, column); })) {
    columns.insert(columns.end(), std::begin(turn), std::end(turn));
  }
  if (has_column(text, gesture)) {
    columns.push_back(gesture);
  }
  return columns;
}

bool closed(const CsvNumbers& csv, std::size_t i, std::size_t column, const std::string& path) {
  const double x = csv(i, column);
  if (x != 0.0 && x != 1.0) {
    throw InputError(path, csv.line(i), std::string(gesture),
                     fmt::format("is {}; allowed: 0 (open hand) or 1 (closed fist)", x));
  }
  return x == 1.0;
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

Recording read_track_csv(const std::string& path) {
  const std::string text = read_text_file(path);
  const std::vector<std::string_view> columns = columns_of(text);
  const bool oriented = columns.size() >= std::size(place) + std::size(turn);
  const bool gestures = columns.back() == gesture;
  const CsvNumbers csv(path, text, columns);
  if (csv.size() == 0) {
    throw InputError(path, 0, "", "has no samples; needed: at least one");
  }
  Recording recording;
  std::vector<TrackSample>& samples = recording.samples;
  recording.gestures = gestures;
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
    if (gestures) {
      sample.closed = closed(csv, i, columns.size() - 1, path);
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
  return recording;
}

}  // namespace core
}  // namespace kairos
