#pragma once

#include "experiments/cli/command_line.hpp"

#include <cstdint>
#include <string>

namespace kairos::experiments {

/// Checks of what a person writes behind an option, for `Argument::check`. Unlike CLI11's own,
/// they let no NaN through, and no negative number into what counts from 0.

/// A finite number from `least` to `most`.
[[nodiscard]] Check finite_number(double least, double most);
/// A whole number from `least` to `most`.
[[nodiscard]] Check whole_number(std::uint64_t least, std::uint64_t most);
/// Any seed: a whole number from 0 to 2^64 - 1.
[[nodiscard]] Check seed_number();
/// A path that is not empty.
[[nodiscard]] Check some_path();

/// Says on stderr what is allowed and hardly meant.
void warn(const std::string& what);

}  // namespace kairos::experiments
