#pragma once

#include "core/frame_times.hpp"

#include <string>
#include <string_view>

namespace kairos {
inline namespace core {

/// Where a text was written, for messages.
struct TextOrigin {
  std::string file;
  int line = 0;
  std::string key;
};

/// Longest duration that is accepted, s.
inline constexpr double longest_duration = 1e12;

/// Seconds from a text: a number ("0.02"), with a unit ("16ms", "0.02s", "250us"), or a fraction
/// ("1/60", "1/60s"). Throws `InputError` unless it is > 0 and <= `longest_duration`.
[[nodiscard]] double parse_duration(std::string_view text, const TextOrigin& origin = {});
/// Frame times from a CSV: one duration a line (s), or the column `duration` of a table with a
/// header. Blank lines and lines that start with # are skipped. Throws `InputError`.
[[nodiscard]] FrameTimes read_frame_csv(const std::string& path);

}  // namespace core
}  // namespace kairos
