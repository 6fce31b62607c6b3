#pragma once

#include <span>
#include <string>
#include <string_view>

namespace kairos {
inline namespace core {

/// The name nearest to `wanted` by edit distance [Levenshtein1966]; empty if none is near enough
/// to be what was meant (more than a third of the letters would have to change).
[[nodiscard]] std::string_view nearest_name(std::string_view wanted,
                                            std::span<const std::string_view> names);
/// `"a, b, c"`.
[[nodiscard]] std::string listed(std::span<const std::string_view> names);
/// The end of a message on an unknown name: `did you mean "x"? allowed: a, b, c`.
[[nodiscard]] std::string suggestion(std::string_view wanted,
                                     std::span<const std::string_view> names);

}  // namespace core
}  // namespace kairos
