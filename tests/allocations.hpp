#pragma once

#include <cstddef>

namespace kairos::test {

/// How often this program has called `operator new` so far.
[[nodiscard]] std::size_t allocations();

}  // namespace kairos::test
