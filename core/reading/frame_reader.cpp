#include "core/reading/frame_reader.hpp"

#include "core/error.hpp"
#include "core/reading/csv.hpp"
#include "core/reading/document.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

/// Takes a unit off the end of the text and returns what it is in seconds.
double take_unit(std::string_view& text) {
  constexpr std::pair<std::string_view, double> units[] = {
      {"ms", 1e3}, {"us", 1e6}, {"ns", 1e9}, {"s", 1.0}};
  for (const auto& [unit, per_second] : units) {
    if (text.ends_with(unit)) {
      text = trimmed(text.substr(0, text.size() - unit.size()));
      return per_second;
    }
  }
  return 1.0;
}

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// Does the first line that is neither blank nor a comment begin with a number?
bool starts_with_number(std::string_view text) {
  text.remove_prefix(text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = unquoted(text.substr(0, end));
    if (!line.empty() && line.front() != '#') {
      return std::string_view("0123456789.+-").find(line.front()) != std::string_view::npos;
    }
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return false;
}

}  // namespace

double parse_duration(std::string_view text, const TextOrigin& origin) {
  std::string_view rest = trimmed(text);
  const double per_second = take_unit(rest);
  const std::size_t slash = rest.find('/');
  const std::optional<double> numerator = parse_number(trimmed(rest.substr(0, slash)));
  const std::optional<double> denominator =
      slash == std::string_view::npos ? 1.0 : parse_number(trimmed(rest.substr(slash + 1)));
  // Dividing, because 16 / 1e3 is the double nearest to 0.016, which 16 * 1e-3 need not be.
  const double seconds = numerator && denominator ? *numerator / *denominator / per_second : 0.0;
  if (!(seconds > 0.0 && seconds <= longest_duration) || !denominator || *denominator < 0.0) {
    throw InputError(origin.file, origin.line, origin.key,
                     fmt::format("\"{}\" is no duration; allowed: seconds > 0 and <= {:g}, such as "
                                 "0.02, \"1/60\", \"16ms\", \"250us\"",
                                 text, longest_duration));
  }
  return seconds;
}

FrameTimes read_frame_csv(const std::string& path) {
  std::string text = read_text_file(path);
  const bool bare = starts_with_number(text);
  if (bare) {  // a list without a header is a table with one column
    text.erase(0, text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
    text.insert(0, "duration\n");
  }
  constexpr std::string_view columns[] = {"duration"};
  const CsvNumbers csv(path, text, columns, bare ? 0 : 1);
  if (csv.size() == 0) {
    throw InputError(path, 0, "", "has no frame times; needed: at least one duration");
  }
  ListedFrames frames;
  frames.path = path;
  for (std::size_t i = 0; i < csv.size(); ++i) {
    const double duration = csv(i, 0);
    if (!(duration > 0.0 && duration <= longest_duration)) {
      throw InputError(
          path, csv.line(i), "duration",
          fmt::format("is {}; allowed: a number > 0 and <= {:g} (s)", duration, longest_duration));
    }
    frames.durations.push_back(duration);
  }
  return frames;
}

}  // namespace core
}  // namespace kairos
