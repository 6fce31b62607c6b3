#pragma once

#include <string>

namespace kairos::experiments {

/// The content of a file for a record of what a run read; nothing where it cannot be opened, as of
/// a scene that never was a file. Throws where it can be opened and not be read.
[[nodiscard]] std::string text_or_nothing(const std::string& path);

}  // namespace kairos::experiments
