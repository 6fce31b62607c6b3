#include "experiments/output/plain_file_name.hpp"

#include <cstddef>

namespace kairos::experiments {

std::string plain_file_name(std::string_view text) {
  constexpr std::size_t longest = 64;
  std::string name;
  for (const char c : text.substr(0, longest)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '_' || c == '-';
    name += plain ? c : '-';
  }
  return name.empty() ? "unnamed" : name;
}

}  // namespace kairos::experiments
