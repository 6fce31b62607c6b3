#pragma once

#include "core/energy_ledger.hpp"
#include "tests/catch.hpp"

#include <cmath>

namespace kairos::tests {

/// Each booking rounds a handful of products: at most 8 eps of all that flowed is unexplained.
inline void check_explained(const EnergyLedger& ledger) {
  CAPTURE(ledger.unexplained(), ledger.flow());
  CHECK(std::abs(ledger.unexplained()) <= 8.0 * 0x1p-52 * ledger.flow());
}

}  // namespace kairos::tests
