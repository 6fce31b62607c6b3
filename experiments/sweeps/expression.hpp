#pragma once

#include <map>
#include <string>
#include <string_view>

namespace kairos::experiments {

using Values = std::map<std::string, double, std::less<>>;

/// Value of an arithmetic expression over named numbers, as sweep specs use it to tie one value to
/// another (`-1 - phase*speed*frame`) and to draw predictions.
///
/// Grammar: `+ - * / ^`, brackets, numbers, names, `pi`, and the functions min, max, abs, sqrt,
/// floor, ceil, log10. Throws `std::invalid_argument` that says what is wrong and where; the
/// result may be non-finite (a division by 0), which callers must not let travel.
[[nodiscard]] double evaluate(std::string_view expression, const Values& values);

/// True if the expression uses that name.
[[nodiscard]] bool uses_name(std::string_view expression, std::string_view name);

}  // namespace kairos::experiments
