#pragma once

#include "experiments/sweeps/spec_section.hpp"
#include "experiments/sweeps/sweep_spec.hpp"

namespace kairos::experiments {

/// Reads one `[[axis]]` of a spec. Throws `InputError`.
[[nodiscard]] Axis read_axis(const SpecSection& section, const Values& constants);

}  // namespace kairos::experiments
