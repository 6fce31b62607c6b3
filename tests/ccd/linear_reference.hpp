#pragma once

#include "ccd/linear/linear_impact.hpp"

namespace kairos::reference {

/// The same question answered in GMP's integers: polynomials over the whole numbers, Sturm
/// sequences, greatest common divisors, and the definition of touching written down with dot
/// products with the normal. Slow, and no line shared with the library.
[[nodiscard]] ccd::LinearImpact reference_impact(const ccd::LinearQuery& query);

}  // namespace kairos::reference
