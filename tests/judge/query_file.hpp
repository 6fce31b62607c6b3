#pragma once

#include "tests/judge/query.hpp"

#include <string>
#include <vector>

namespace kairos::judge {

/// The queries of a file in the format of `kairos toi`; columns that it lacks keep their defaults.
/// Throws `std::runtime_error` where a number is none.
[[nodiscard]] std::vector<Query> read_queries(const std::string& path);

}  // namespace kairos::judge
