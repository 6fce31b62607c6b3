#pragma once

#include "experiments/output/table.hpp"

namespace kairos::experiments {

/// The systems of the thesis' review and what followed them: what each answers and how, what
/// answers it here, and what is guaranteed.
[[nodiscard]] Table reviewed_systems();

}  // namespace kairos::experiments
