#pragma once

#include <cstdlib>

namespace kairos::tests {

/// Whether `./test --thorough` runs: some tests then have more cases, or longer ones.
inline bool thorough() { return std::getenv("KAIROS_THOROUGH") != nullptr; }

}  // namespace kairos::tests
