#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kairos {
inline namespace simulation {

/// The version of kairos.
[[nodiscard]] std::string_view version();
/// Name and version of kairos and of all that decides the bits of a run.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> versions();

}  // namespace simulation
}  // namespace kairos
