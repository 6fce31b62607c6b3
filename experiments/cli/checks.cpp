#include "experiments/cli/checks.hpp"

#include "core/reading/csv.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <limits>
#include <system_error>

namespace kairos::experiments {

Check finite_number(double least, double most) {
  const std::string range = fmt::format("{} - {}", least, most);
  return {range, [least, most](const std::string& text) {
            const auto x = parse_number(text);
            return x && *x >= least && *x <= most
                       ? std::string()
                       : fmt::format("'{}' is not allowed; allowed: a finite number from {} to {}",
                                     text, least, most);
          }};
}

Check whole_number(std::uint64_t least, std::uint64_t most) {
  const std::string range = fmt::format("{} - {}", least, most);
  return {range, [least, most](const std::string& text) {
            std::uint64_t n = 0;
            const char* const end = text.data() + text.size();
            const auto [stop, error] = std::from_chars(text.data(), end, n);
            return error == std::errc() && stop == end && n >= least && n <= most
                       ? std::string()
                       : fmt::format("'{}' is not allowed; allowed: a whole number from {} to {}",
                                     text, least, most);
          }};
}

Check seed_number() {
  Check check = whole_number(0, std::numeric_limits<std::uint64_t>::max());
  check.range.clear();
  return check;
}

Check some_path() {
  return {"", [](const std::string& text) {
            return text.empty() ? std::string("is empty; allowed: the name of a file or a folder")
                                : std::string();
          }};
}

void warn(const std::string& what) { fmt::print(stderr, "warning: {}\n", what); }

}  // namespace kairos::experiments
