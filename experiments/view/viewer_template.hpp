#pragma once

#include <string>

namespace kairos::experiments {

/// The page of `kairos view` without data, beside the installed program or in the build tree; empty
/// if it was not built.
[[nodiscard]] std::string viewer_template();

}  // namespace kairos::experiments
