#pragma once

#include <string>
#include <string_view>

namespace kairos::experiments {

/// A text as the name of a file: what is not a letter, digit, `_` or `-` becomes `-`, and at most
/// 64 characters of it. The name of a scene may be anything; a file of its name stays where it
/// belongs.
[[nodiscard]] std::string plain_file_name(std::string_view text);

}  // namespace kairos::experiments
