#pragma once

#include "experiments/extremes/extremes_experiment.hpp"

#include <string>

namespace kairos::experiments {

/// Which line of our reading of the thesis (its numbered predictions, its scheme as read) explains
/// what its method got wrong in a cell. A test measures that the explanation holds in each.
[[nodiscard]] std::string why_thesis_is_wrong(const ExtremeCase& extreme, const Judged& judged);

}  // namespace kairos::experiments
