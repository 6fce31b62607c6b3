#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kairos {
inline namespace simulation {

/// Of kairos.
[[nodiscard]] std::string_view version();
/// Of kairos and of what decides the bits of a run: name and version.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> versions();

}  // namespace simulation
}  // namespace kairos
