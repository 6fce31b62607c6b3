#include "core/free_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>

namespace kairos {
inline namespace core {
namespace {

/// The number behind a key at the start of a line; nothing where there is no number.
std::optional<double> number_behind(const std::string& path, const std::string& key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(key)) {
      std::istringstream words(line.substr(key.size()));
      double number = 0.0;
      return words >> number ? std::optional(number) : std::nullopt;
    }
  }
  return std::nullopt;
}

/// How much may still be used below a limit, in its unit; infinite where there is no limit.
double left_of(const std::optional<double>& limit, const std::optional<double>& used) {
  return limit ? std::max(*limit - used.value_or(0.0), 0.0)
               : std::numeric_limits<double>::infinity();
}

}  // namespace

double free_memory() {
  constexpr double kibi = 1024.0;
  const double machine = left_of(number_behind("/proc/meminfo", "MemAvailable:"), 0.0) * kibi;
  const auto size = number_behind("/proc/self/status", "VmSize:");
  const double process = left_of(number_behind("/proc/self/limits", "Max address space"),
                                 size ? std::optional(*size * kibi) : std::nullopt);
  const double group = left_of(number_behind("/sys/fs/cgroup/memory.max", ""),
                               number_behind("/sys/fs/cgroup/memory.current", ""));
  return std::min({machine, process, group});
}

std::string why_no_room(std::size_t bodies, double bytes_a_body, double free) {
  const double needed = bytes_a_body * static_cast<double>(bodies);
  if (needed <= free) {
    return {};
  }
  return fmt::format(
      "{} bodies take some {:.0f} bytes of memory, {:.0f} a body, and {:.0f} are free; there is "
      "room for {:.0f}",
      bodies, needed, bytes_a_body, free, std::floor(free / bytes_a_body));
}

}  // namespace core
}  // namespace kairos
