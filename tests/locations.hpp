#pragma once

#include <string>

namespace kairos::tests {

/// `file` of the source tree, e.g. `scenes/bounce.toml`.
[[nodiscard]] std::string source_path(const std::string& file);

}  // namespace kairos::tests
