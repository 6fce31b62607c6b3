#pragma once

#include <string>
#include <string_view>

namespace kairos::experiments::thesis {

/// The text of a test of this project by its full name, with the file it stands in on the first
/// line. Empty where the sources are not at hand (an installed program).
[[nodiscard]] std::string test_excerpt(std::string_view name);

}  // namespace kairos::experiments::thesis
