#pragma once

#include <string>
#include <string_view>

namespace kairos {
inline namespace core {

/// Refuses a TOML text that is nested more deeply than any document of ours: keys of more than 32
/// parts (`a.b.c`), or arrays and inline tables more than 32 within each other. A parser makes a
/// table of each part, and takes them apart again one within the other: 60,000 of them end the
/// stack. Throws `InputError` with the line. What is no TOML is left to the parser.
void refuse_deep_nesting(std::string_view text, const std::string& file);

}  // namespace core
}  // namespace kairos
